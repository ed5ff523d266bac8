"""The traps of front_cmd and of emg_stop in the stand-in of OperaSim-PhysX, in virtual time."""

import pytest

from operasim.drive import Drive
from operasim.front import Front
from operasim.machine import Machine
from operasim.model import Placed, Unknowns, machine

STEP = 0.02
FOUR = ["swing_joint", "boom_joint", "arm_joint", "bucket_joint"]


@pytest.fixture
def zx200() -> Machine:
    return Machine(machine("zx200"), Placed(model="zx200", place=(0.0, 0.0, 0.0)), Unknowns())


def drive(of: Machine, name: str) -> Drive:
    found = of.joints[name]
    assert found is not None
    return found


class Target:
    """A front whose joints have dead times of 0.1 and 0.5 s, and one without; keeps what it aims at."""

    def __init__(self) -> None:
        self.aimed: list[tuple[str, float]] = []
        self.front = Front({"slow": 0.5, "quick": 0.1, "end": None}, lambda *aim: self.aimed.append(aim))

    def steps(self, begin: float, end: float) -> list[tuple[str, float]]:
        """What it aims at in the steps of this time."""
        self.aimed.clear()
        for i in range(round(begin / STEP), round(end / STEP)):
            self.front.step(i * STEP)
        return list(self.aimed)


def test_each_joint_has_a_queue_of_its_own() -> None:
    target = Target()
    target.front.command(["slow", "quick"], [1.0, 2.0], 0.0)
    assert target.steps(0.0, 0.3) == [("quick", 2.0)]
    assert target.steps(0.3, 1.0) == [("slow", 1.0)]


def test_the_newest_of_those_that_are_due_wins() -> None:
    target = Target()
    for i in range(3):
        target.front.command(["quick"], [float(i)], 0.001 * i)
    assert target.steps(0.0, 1.0) == [("quick", 2.0)]


def test_a_message_with_fewer_joints_freezes_the_others() -> None:
    target = Target()
    target.front.command(["slow", "quick"], [1.0, 2.0], 0.0)
    target.front.command(["quick"], [3.0], 0.05)
    assert target.steps(0.0, 2.0) == [("quick", 2.0), ("quick", 3.0)]
    target.front.command(["slow"], [4.0], 2.0)
    assert target.steps(2.0, 3.0) == [("slow", 1.0), ("slow", 4.0)]


@pytest.mark.parametrize("first", ["end", "unknown"])
def test_the_walk_ends_at_the_first_joint_without_dead_time(first: str) -> None:
    target = Target()
    target.front.command([first, "quick"], [1.0, 2.0], 0.0)
    assert ("quick", 2.0) not in target.steps(0.0, 2.0)
    target.front.command(["quick", first], [3.0, 1.0], 2.0)
    assert target.steps(2.0, 3.0) == [("quick", 2.0), ("quick", 3.0)]


def test_a_joint_without_dead_time_is_aimed_at_once() -> None:
    target = Target()
    target.front.command(["end"], [1.0], 0.0)
    assert target.aimed == [("end", 1.0)]


def test_too_few_values_end_a_message_in_the_middle() -> None:
    target = Target()
    with pytest.raises(IndexError):
        target.front.command(["quick", "slow"], [1.0], 0.0)
    assert target.steps(0.0, 2.0) == [("quick", 1.0)]


def test_an_end_of_the_commands_is_no_stop(zx200: Machine) -> None:
    for i in range(10):
        zx200.joint_cmd(FOUR, [0.1 * i] * 4, 0.1 * i)
    aimed = []
    for i in range(46, 100):  # the last command was sent at 0.9 s
        zx200.scripts(i * STEP)
        aimed.append(drive(zx200, "swing_joint").target)
    assert aimed[0] == 0.0
    assert aimed[-1] == pytest.approx(0.9)


def test_float_commands_have_no_dead_time_and_the_last_writer_wins(zx200: Machine) -> None:
    zx200.joint_cmd(["bucket_joint"], [1.0], 0.0)
    zx200.angle("bucket_joint", 0.2)
    zx200.scripts(0.02)
    assert drive(zx200, "bucket_joint").target == 0.2
    zx200.scripts(0.4)
    assert drive(zx200, "bucket_joint").target == 1.0


def test_a_stop_holds_the_joints_where_its_first_step_finds_them(zx200: Machine) -> None:
    boom = drive(zx200, "boom_joint")
    zx200.tracks.twist(1.0, 0.0)
    for i in range(25):
        zx200.scripts(i * STEP)
        zx200.physics(STEP)
    there = boom.position
    zx200.emg_stop(True)
    zx200.joint_cmd(FOUR, [0.5] * 4, 0.5)
    zx200.angle("boom_joint", 0.5)
    for i in range(25, 300):
        zx200.scripts(i * STEP)
        zx200.physics(STEP)
        assert boom.target == there
    assert boom.position == pytest.approx(there, abs=2e-3)
    assert zx200.tracks.forward == 0.0
    zx200.emg_stop(False)
    for i in range(300, 350):
        zx200.scripts(i * STEP)
        zx200.physics(STEP)
    assert (boom.target, zx200.tracks.forward) == (there, 0.0)  # what came meanwhile was ignored, tracks stay


def test_a_stop_leaves_commands_in_the_queue(zx200: Machine) -> None:
    """A stream of 10 Hz, a stop of 0.3 s: old targets play until 0.88 s after the stop, over a hold sent meanwhile."""
    swing, stopped_at, released_at = drive(zx200, "swing_joint"), 1.96, 2.26
    sent, changes, last = 0, [], None
    for i in range(1, 250):
        now = i * STEP
        if now < stopped_at and now >= 0.1 * sent:
            zx200.joint_cmd(FOUR, [0.01 * sent, -0.5, 1.5, 0.5], now)
            sent += 1
        if i == round(stopped_at / STEP):
            zx200.emg_stop(True)
        if i == round(released_at / STEP):
            zx200.emg_stop(False)
        zx200.scripts(now)
        if i == round(released_at / STEP):
            flushed = swing.target
            zx200.angle("swing_joint", -1.0)
        if now > released_at and swing.target != last:
            changes.append(now - stopped_at)
            last = swing.target
        zx200.physics(STEP)
    assert flushed == pytest.approx(0.01 * 13)  # the newest whose dead time had ended: sent 0.96 s before
    assert swing.target == pytest.approx(0.01 * (sent - 1))  # the hold was overridden
    assert changes[-1] == pytest.approx(0.88, abs=0.03)


def test_after_the_longest_dead_time_a_release_moves_nothing_younger(zx200: Machine) -> None:
    zx200.joint_cmd(FOUR, [0.3] * 4, 0.0)
    zx200.emg_stop(True)
    zx200.scripts(0.02)
    zx200.scripts(1.0)
    zx200.emg_stop(False)
    zx200.scripts(1.02)
    assert zx200.front.queued == {}
    zx200.angle("swing_joint", 0.0)
    zx200.scripts(2.0)
    assert drive(zx200, "swing_joint").target == 0.0


def test_rot_dump_cmd_has_no_dead_time() -> None:
    one = Machine(machine("mst110cr"), Placed(model="mst110cr", place=(0.0, 0.0, 0.0)), Unknowns())
    one.joint_cmd(["rotate_joint", "dump_joint"], [0.5, -0.2], 0.0)
    assert (drive(one, "rotate_joint").target, drive(one, "dump_joint").target) == (0.5, -0.2)
