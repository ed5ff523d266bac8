"""What the facts of a machine change: which of its reports are motions, and how long a proof waits."""

import pytest

from tms_proof.channel import WORST
from tms_proof.facts import JointFacts
from tms_proof.proof import INFINITE, NOTHING, SEEN, Expected, Proof
from tms_proof.standstill import HEADING, OBEYS, ODOM, PLACE, StandStill
from unit.tms_proof.told_machine import ARM, BOOM, NO_STOPS, PERIOD, joints, machine, tell


def bases(watch: StandStill, x: tuple[float, ...], heading: tuple[float, ...]) -> None:
    for i, (along, angle) in enumerate(zip(x, heading, strict=True)):
        tell(watch, ODOM, PERIOD * i, {PLACE: (along, 0.0), HEADING: (angle,)})


def swings(watch: StandStill, *angles: float) -> bool:
    """Whether a joint that is told at these angles moves."""
    for i, angle in enumerate(angles):
        joints(watch, PERIOD * i, boom=angle)
    return watch.moving()


# when something counts as standing


def test_only_a_joint_without_any_end_stop_turns() -> None:
    wraps = (3.1415926, -3.1415926, 3.1415926)
    assert not swings(machine({"boom": NO_STOPS}), *wraps)
    assert swings(machine({"boom": JointFacts(1.0, low=-3.5)}), *wraps)
    assert swings(machine({"boom": JointFacts(1.0, high=3.5)}), *wraps)


def test_jitter_of_joints_is_no_motion() -> None:
    assert not swings(machine(jitter=0.01), 0.0, 0.008, 0.0)
    assert swings(machine(), 0.0, 0.008, 0.0)


def test_a_joint_of_a_quick_stand_in_stands_below_the_limit_of_its_own_time() -> None:
    assert not swings(machine(speed=4.0), 0.0, 0.001, 0.002)
    assert swings(machine(), 0.0, 0.001, 0.002)


def test_jitter_of_the_base_is_no_motion() -> None:
    for watch in (machine(sources=(ODOM,), jitter=0.01), machine(sources=(ODOM,))):
        bases(watch, (0.0, 0.008, 0.0), (0.0, 0.008, 0.0))
        assert watch.moving() == (watch.sources[ODOM].source.resolution == 0.0)


@pytest.mark.parametrize(("x", "heading"), [(0.0, 0.001), (0.002, 0.0)])
def test_a_base_moves_by_its_place_or_heading(x: float, heading: float) -> None:
    for speed in (1.0, 4.0):
        watch = machine(sources=(ODOM,), speed=speed)
        bases(watch, (0.0, x, 2 * x), (0.0, heading, 2 * heading))
        assert watch.moving() == (speed == 1.0)


def test_a_heading_may_wrap() -> None:
    watch = machine(sources=(ODOM,))
    bases(watch, (0.0, 0.0, 0.0), (3.1415926, -3.1415926, 3.1415926))
    assert not watch.moving()


def test_a_base_that_turns_and_drives_as_fast_as_it_can_surprises_nobody() -> None:
    watch = machine(sources=(ODOM,))
    bases(watch, (0.0, 0.1, 0.2), (0.0, 0.05, 0.1))
    assert watch.moving() and watch.sources[ODOM].surprised == -INFINITE
    leaps = machine(sources=(ODOM,))
    bases(leaps, (0.0, 0.0, 0.0), (0.0, 0.2, 0.2))
    assert leaps.sources[ODOM].surprised > 0.0


# how long a proof waits


def test_times_are_those_of_the_slowest_joint_as_a_stand_in_has_them() -> None:
    watch = machine(responses={"boom": BOOM, "bucket": ARM}, speed=2.0)
    assert (watch.dead_time, watch.braking, watch.reached) == (0.3, 1.4, pytest.approx(1.4))
    assert watch.dead_times == {"boom": 0.3, "arm": 0.0}  # no command moves the arm
    assert watch.settles == pytest.approx(0.3 + 1.4 + OBEYS)


def test_a_machine_that_no_command_moves_needs_no_time() -> None:
    watch = machine(responses={})
    assert (watch.dead_time, watch.braking, watch.reached) == (0.0, 0.0, 0.0)


def test_a_proof_that_begins_later_waits_for_an_unseen_motion_from_then_on_too() -> None:
    assert Proof(1.0, 2.0, NOTHING, 0.2).later(5.0) == Proof(5.0, 5.0, NOTHING, 0.2)
    assert Proof(1.0, 7.0, NOTHING, 0.2).later(0.5) == Proof(1.0, 7.0, NOTHING, 0.2)


def test_of_two_stops_each_joint_s_longer_way_must_be_seen() -> None:
    first = Proof(1.0, 2.0, Expected(0.5, {"boom": 0.2, "swing": 0.4}), 0.2)
    second = Proof(3.0, 4.0, Expected(None, {"arm": 0.3, "boom": 0.1}), 0.3)
    both = Proof(3.0, 4.0, Expected(0.5, {"boom": 0.2, "swing": 0.4, "arm": 0.3}), 0.3)
    assert second.after(first) == both
    assert first.after(second) == both


def stopped_at(begun: float, moved: bool, commanded: float) -> float:
    """Seconds that a stop which acts at once waits for: the machine began to move at 0 s, or never did."""
    watch = machine(at_once=True)
    for at, angle in ((-PERIOD, 0.0), (0.0, 0.1 if moved else 0.0)):
        joints(watch, at, boom=angle)
    watch.commanded(commanded)
    return watch.proof(begun, strongest=True).start - begun


def test_a_stop_that_acts_at_once_needs_no_dead_time_where_it_was_seen_to_move_or_nothing_is_on_its_way() -> None:
    assert stopped_at(0.1, moved=True, commanded=0.1) == 0.0
    assert stopped_at(WORST, moved=True, commanded=WORST) == pytest.approx(0.6), "too long ago"
    assert stopped_at(0.6, moved=False, commanded=0.0) == pytest.approx(0.6), "a command may just arrive"
    assert stopped_at(0.7, moved=False, commanded=0.0) == 0.0


def test_a_motion_too_small_to_be_seen_need_not_be_seen() -> None:
    small = Expected(None, {"boom": SEEN, "arm": 2 * SEEN})
    assert machine().proof(0.0, strongest=False, expected=small).expected.to_come == {"arm": 2 * SEEN}


def proven(expected: Expected, way: float) -> bool:
    """Whether a stop is proven by a second of standing after the joint `boom` has gone a way at 0 s."""
    watch = machine()
    joints(watch, -0.15)
    watch.mark()
    for i in range(30):
        joints(watch, PERIOD * i, boom=way)
    return watch.proven(Proof(0.0, 100.0, expected, 0.2), 29 * PERIOD)


def test_half_the_way_of_each_joint_that_was_commanded_must_be_seen() -> None:
    assert proven(Expected(None, {"boom": 0.2}), 0.1)
    assert not proven(Expected(None, {"boom": 0.2}), 0.09)
    assert not proven(Expected(None, {"arm": 0.2}), 0.1)


def test_a_way_that_nobody_could_measure_was_not_seen() -> None:
    """The joints were heard for the first time after the mark."""
    watch = machine()
    watch.mark()
    for i in range(30):
        joints(watch, PERIOD * i)
    assert not watch.proven(Proof(0.0, 100.0, Expected(None, {"boom": 0.2}), 0.2), 29 * PERIOD)
    assert watch.proven(Proof(0.0, 100.0, NOTHING, 0.2), 29 * PERIOD)


def test_the_expected_motion_must_be_seen_after_it_was_commanded() -> None:
    assert proven(Expected(-0.1), 0.1)
    assert not proven(Expected(0.0), 0.1)
