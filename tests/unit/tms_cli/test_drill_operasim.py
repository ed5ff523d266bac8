"""The true motion of the simulator's machines, from two states of its control port."""

from typing import Any

import pytest

from tms_cli.drill.operasim import sample_between
from tms_config.models import Still

STILL = Still(velocity=0.01, linear=0.02, angular=0.01, seconds=0.2, origin="test")


def state(place: tuple[float, float] = (0.0, 0.0), yaw: float = 0.0, speed: float = 0.0) -> dict[str, Any]:
    joints = {"boom_joint": {"position": -0.5, "velocity": speed}, "arm_joint": {"position": 1.0, "velocity": 0.0}}
    return {"joints": joints, "place": [*place, 0.1], "yaw": yaw}


@pytest.mark.parametrize(
    ("before", "after", "share"),
    [
        (state(), state(), 0.0),
        (state(), state(speed=-0.03), 3.0),
        (state(), state(place=(0.003, 0.004)), 2.5),
        (state(yaw=0.1), state(yaw=0.098), 2.0),
    ],
)
def test_the_fastest_part_counts(before: dict[str, Any], after: dict[str, Any], share: float) -> None:
    sample = sample_between((1000.0, 20.0, before), (1000.1, 20.1, after), STILL)
    assert sample.share == pytest.approx(share)
    assert sample.at == 1000.1
    assert sample.joints == {"boom_joint": -0.5, "arm_joint": 1.0, "heading": after["yaw"]}


@pytest.mark.parametrize("later", [20.0, 0.5])
def test_nothing_moves_while_the_simulator_is_paused_or_begins_anew(later: float) -> None:
    sample = sample_between((1000.0, 20.0, state()), (1000.1, later, state((5.0, 0.0), 1.0, 0.5)), STILL)
    assert sample.share == 0.0
