"""Presses of the stop button that a gateway may have died of."""

import pytest

from tms_decision.duty import NOTED
from tms_ts.missed_presses import MissedPresses


@pytest.fixture
def presses() -> MissedPresses:
    return MissedPresses(["zx200", "ic120"])


def missed(presses: MissedPresses) -> set[str]:
    return {machine for machine in ("zx200", "ic120") if machine in presses}


def test_a_press_is_missed_until_the_machine_shows_a_latch(presses: MissedPresses) -> None:
    assert missed(presses) == set()
    presses.pressed(10.0)
    presses.shows("zx200", latched=False)  # it has not heard it yet
    assert missed(presses) == {"zx200", "ic120"}
    presses.shows("zx200", latched=True)
    assert missed(presses) == {"ic120"}


def test_a_press_on_a_machine_that_shows_its_latch_is_over_with_its_re_arm(presses: MissedPresses) -> None:
    presses.shows("zx200", latched=True)
    presses.pressed(10.0)
    assert missed(presses) == {"ic120"}
    presses.shows("zx200", latched=False)
    assert missed(presses) == {"ic120"}


def test_a_latch_of_a_lost_gateway_may_not_be_on_its_disk(presses: MissedPresses) -> None:
    presses.pressed(10.0)
    for machine in ("zx200", "ic120"):
        presses.shows(machine, latched=True)
    presses.lost("zx200", 10.0 + NOTED - 0.1)
    presses.lost("ic120", 10.0 + NOTED)
    assert missed(presses) == {"zx200"}


@pytest.mark.parametrize("in_order", [True, False])
def test_what_a_gateway_has_shown_says_nothing_of_its_successor(presses: MissedPresses, in_order: bool) -> None:
    presses.shows("zx200", latched=True)
    if in_order:
        presses.left("zx200")
    else:
        presses.lost("zx200", 5.0)
    assert missed(presses) == set()
    presses.pressed(10.0)
    assert missed(presses) == {"zx200", "ic120"}


def test_the_latch_of_a_gateway_that_ends_in_order_is_on_its_disk(presses: MissedPresses) -> None:
    presses.pressed(10.0)
    presses.shows("zx200", latched=True)
    presses.left("zx200")
    assert missed(presses) == {"ic120"}
