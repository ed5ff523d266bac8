"""The true motion of the simulator's machines, from what its control port tells."""

from typing import Any

import pytest

from tms_cli.drill.operasim import Told, sample_of
from tms_config.models import Still

STILL = Still(velocity=0.01, linear=0.02, angular=0.01, seconds=0.2, origin="test")


def told(joint: float = 0.0, speed: float = 0.0, turning: float = 0.0) -> Told:
    joints = {"boom_joint": {"position": -0.5, "velocity": joint}, "arm_joint": {"position": 1.0, "velocity": 0.0}}
    machine: dict[str, Any] = {"joints": joints, "place": [3.0, 4.0, 0.1], "yaw": 0.2}
    return Told(1000.0, 20.0, machine | {"speed": speed, "turning": turning})


@pytest.mark.parametrize(
    ("found", "share"), [(told(), 0.0), (told(joint=-0.03), 3.0), (told(speed=-0.05), 2.5), (told(turning=-0.02), 2.0)]
)
def test_the_fastest_part_counts(found: Told, share: float) -> None:
    sample = sample_of(found, STILL, paused=False)
    assert sample.share == pytest.approx(share)
    assert (sample.at, sample.place) == (1000.0, (3.0, 4.0))
    assert sample.joints == {"boom_joint": -0.5, "arm_joint": 1.0, "heading": 0.2}


def test_nothing_moves_while_the_simulator_is_paused() -> None:
    assert sample_of(told(0.5, 0.5, 0.5), STILL, paused=True).share == 0.0
