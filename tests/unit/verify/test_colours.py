"""What Groot must have shown of a run."""

from collections.abc import Sequence

import pytest

from verify import colours
from verify.colours import GREEN, GREY, ORANGE, RED, Change, Shape

SHAPE = Shape({"root": "", "dig": "root", "lower": "dig", "release": "root", "open": "release"})
LOWERED = [("lower", GREY, ORANGE), ("lower", ORANGE, GREEN), ("lower", GREEN, GREY)]
OPENED = [("open", GREY, ORANGE), ("open", ORANGE, GREEN), ("open", GREEN, GREY)]
SUCCESS = [
    ("root", GREY, ORANGE), ("dig", GREY, ORANGE), *LOWERED, ("dig", ORANGE, GREEN),
    ("release", GREY, ORANGE), *OPENED, ("release", ORANGE, GREEN), ("root", ORANGE, GREEN), ("root", GREEN, GREY),
]  # fmt: skip
BEGUN = SUCCESS[:3]
HALTED = [*BEGUN, ("lower", ORANGE, GREY), ("dig", ORANGE, GREY), ("root", ORANGE, GREY)]
FAILED = [*BEGUN, ("lower", ORANGE, RED), ("dig", ORANGE, RED), ("root", ORANGE, RED), ("root", RED, GREY)]


def seen(steps: Sequence[tuple[str, int, int]]) -> list[Change]:
    return [Change(node, old, new, float(at), float(at)) for at, (node, old, new) in enumerate(steps)]


def test_leaves_and_what_is_above_them() -> None:
    assert SHAPE.leaves == ["lower", "open"]
    assert SHAPE.above("open") == ["open", "release", "root"]


def test_a_run_in_order_is_right() -> None:
    assert colours.wrong_of_success(seen(SUCCESS), SHAPE) == []


@pytest.mark.parametrize("left_out", [0, 3, 5, 7, 11])
def test_a_colour_that_nobody_saw_is_wrong(left_out: int) -> None:
    steps = SUCCESS[:left_out] + SUCCESS[left_out + 1 :]
    assert colours.wrong_of_success(seen(steps), SHAPE)


@pytest.mark.parametrize(("first", "second"), [(3, 7), (2, 7), (3, 5), (10, 11)])
def test_another_order_is_wrong(first: int, second: int) -> None:
    steps = list(SUCCESS)
    steps[first], steps[second] = steps[second], steps[first]
    assert colours.wrong_of_success(seen(steps), SHAPE)


def test_a_failure_is_red_up_to_the_root() -> None:
    assert colours.wrong_of_failure(seen(FAILED), SHAPE, "lower") == []
    assert colours.wrong_of_failure(seen(HALTED), SHAPE, "lower")
    assert colours.wrong_of_failure(seen([*FAILED, ("open", GREY, ORANGE)]), SHAPE, "lower")


def test_a_halt_leaves_nothing_orange() -> None:
    assert colours.wrong_of_halt(seen(HALTED), SHAPE, "lower") == []
    assert colours.wrong_of_halt(seen(HALTED[:-1]), SHAPE, "lower") == ["root: grey, orange"]
    assert colours.wrong_of_halt(seen(SUCCESS), SHAPE, "lower")
    assert colours.wrong_of_halt(seen([*HALTED, ("open", GREY, ORANGE)]), SHAPE, "lower")
