"""The order in which a run ended, and when a machine truly stood."""

import pytest

from verify import history
from verify.truth import JOINTS, Sample, stood, travel

KINDS = ["run", "run", "node", "goal", "goal", "run", "node", "node", "stop", "goal", "run"]


def events(kinds: list[str]) -> list[history.Event]:
    return [{"kind": kind, "stamp": f"2026-01-01T00:00:{at:02}+00:00"} for at, kind in enumerate(kinds)]


def test_root_nodes_stop_goal_end() -> None:
    assert history.wrong_of_cancel(events(KINDS)) == []
    assert history.wrong_of_cancel(events([*KINDS[:-1], "stop", "run"])) == []
    assert history.halted_within(events(KINDS)) == 2.0


@pytest.mark.parametrize("tail", [["run", "node", "goal", "run"], ["run", "stop", "node", "goal", "run"],
                                  ["run", "node", "goal", "stop", "run"], ["run", "node", "stop", "run"]])  # fmt: skip
def test_another_order_is_wrong(tail: list[str]) -> None:
    assert history.wrong_of_cancel(events([*KINDS[:5], *tail]))


def sample(at: float, position: float, velocity: float) -> Sample:
    return Sample(at, dict.fromkeys(JOINTS, position), dict.fromkeys(JOINTS, velocity))


def test_it_stood_with_the_first_still_sample_of_the_last_ones() -> None:
    still = [sample(0, 0.0, 0.5), sample(1, 0.5, 0.0), sample(2, 0.5, 0.2), sample(3, 0.7, 0.0), sample(4, 0.7, 0.0)]
    assert stood(still) == 3
    assert stood(still[:3]) is None
    assert stood(still[3:]) == 3
    assert stood([]) is None
    assert travel(still) == pytest.approx(0.7)
