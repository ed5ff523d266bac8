"""What is told under each fault that lies, and that nothing is changed without one."""

import math

import pytest

from tms_config.site_file import Fault
from tms_sim.sensor_model import SECOND, Reading, SensorModel

KEPT = 50


def reading(tick: int) -> Reading:
    """A machine that moves all the time, 25 Hz."""
    t = tick * 0.04
    return Reading(round(t * SECOND), (t, -t), (1.0, -1.0), (2 * t, 3 * t, 0.5), (2.0, 0.1))


def reported(**fault: object) -> list[tuple[Reading, Reading]]:
    """What is true and what is told, for 100 looks; the fault begins after 60."""
    report, later = SensorModel(KEPT), Fault.model_validate(fault)
    return [(reading(i), report.apply(reading(i), later if i >= 60 else Fault())) for i in range(100)]


def test_without_a_fault_the_truth_is_told() -> None:
    assert all(true == said for true, said in reported())
    assert all(true == said for true, said in reported(zero_velocity=True)[:60])


def test_zero_velocity_moves_without_saying_so() -> None:
    for true, said in reported(zero_velocity=True)[60:]:
        assert said == true._replace(velocities=(0.0, 0.0), speeds=(0.0, 0.0))


def test_frozen_stamp_tells_the_last_message_again() -> None:
    seen = reported(frozen_stamp=True)
    assert {said for _, said in seen[60:]} == {reading(59)}


def test_a_fault_that_is_over_leaves_no_trace() -> None:
    report = SensorModel(KEPT)
    report.apply(reading(0), Fault(frozen_stamp=True))
    assert report.apply(reading(1), Fault()) == reading(1)
    assert report.apply(reading(2), Fault(frozen_stamp=True)) == reading(1)


def test_replay_loops_the_last_two_seconds_with_new_stamps() -> None:
    seen = reported(replay=True)[60:]
    assert [said.stamp for _, said in seen] == [true.stamp for true, _ in seen]
    assert [said.positions for _, said in seen] == [reading(10 + i % KEPT).positions for i in range(40)]
    report = SensorModel(2)
    for i in range(4):
        report.apply(reading(i), Fault())
    again = [report.apply(reading(4 + i), Fault(replay=True)).positions for i in range(4)]
    assert again == [reading(2).positions, reading(3).positions] * 2


def test_jump_displaces_joints_and_place() -> None:
    for true, said in reported(jump=0.3)[60:]:
        assert said.positions == pytest.approx([q + 0.3 for q in true.positions])
        assert said.place == pytest.approx((true.place[0] + 0.3, true.place[1] + 0.3, true.place[2]))
        assert said.velocities == true.velocities


def test_nan_is_every_number_but_the_stamp() -> None:
    for true, said in reported(nan=True)[60:]:
        assert said.stamp == true.stamp
        assert all(math.isnan(n) for part in said[1:] for n in part)


def test_back_in_time_is_a_jump_of_the_stamp() -> None:
    seen = reported(back_in_time=5.0)
    assert seen[60][1].stamp < seen[59][1].stamp
    assert all(true.stamp - said.stamp == 5 * SECOND for true, said in seen[60:])
