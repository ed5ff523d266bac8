"""Where a machine may be, why it cannot be believed, and how far it went."""

import pytest

from tms_proof.facts import JointFacts
from tms_proof.proof import INFINITE, NOTHING, Proof
from tms_proof.reasons import Beyond, JointStates, Moving, NewClock, NotLongEnough, TwoPublishers
from tms_proof.source import SourceSample
from tms_proof.standstill import HARD, JOINTS, ODOM, StandStill, Travel
from unit.tms_proof.told_machine import PERIOD, joints, machine, tell


def stands(watch: StandStill, begin: float = 0.0, seconds: float = 1.0) -> float:
    """It stands, and tells so, until the time that is returned."""
    count = round(seconds / PERIOD)
    for i in range(count + 1):
        joints(watch, begin + PERIOD * i)
    return begin + PERIOD * count


def starts_its_clock_anew(watch: StandStill, now: float) -> float:
    """The stamps begin with 0 again while it stands; until when."""
    for i in range(20):
        now += PERIOD
        watch.take(JOINTS, SourceSample(now, PERIOD * i, 0, {"boom": (0.0,), "arm": (0.0,)}, {}))
    return now


def test_before_anything_is_heard_nothing_is_wrong_and_it_went_nowhere() -> None:
    watch = machine()
    assert watch.trouble(0.0) is None and watch.travel() == Travel()


def test_a_machine_without_sources_is_never_proven_to_stand() -> None:
    watch = machine(sources=())
    assert watch.age(1.0) == INFINITE and watch.seen(1.0) == {}
    assert not watch.proven(Proof(0.0, 0.0, NOTHING, 0.2), 1.0)


def test_angles_are_known_as_long_as_they_are_news() -> None:
    watch = machine()
    joints(watch, 0.0, boom=0.5)
    assert watch.seen(watch.sources[JOINTS].longest) == {"boom": 0.5, "arm": 0.0}
    assert watch.seen(watch.sources[JOINTS].longest + 0.01) == {}


def test_its_age_is_that_of_the_source_that_is_silent_for_longest() -> None:
    watch = machine(sources=(JOINTS, ODOM))
    joints(watch, 1.0)
    tell(watch, ODOM, 2.0, {"place": (0.0, 0.0), "heading": (0.0,)})
    assert watch.age(3.0) == 2.0


# what is wrong


@pytest.mark.parametrize("limit", [-3.0, 3.0])
def test_a_joint_may_be_a_little_beyond_its_limits_and_not_further(limit: float) -> None:
    beyond = limit + HARD if limit > 0 else limit - HARD
    watch = machine()
    for at, angle in ((0.0, limit * 0.99), (0.1, beyond)):
        joints(watch, at, boom=angle)
        assert watch.trouble(at) is None
    joints(watch, 0.2, boom=1.01 * beyond)
    trouble = watch.trouble(0.2)
    assert trouble is not None and trouble.reason == Beyond(JointStates(), "boom", 1.01 * beyond, limit)


def test_a_trouble_that_does_not_pass_is_told_first() -> None:
    watch = machine({"boom": JointFacts(1.0, -3.0, 3.0)})
    joints(watch, 5.0)
    for at in (6.0, 6.1):
        watch.take(JOINTS, SourceSample(at, at - 5.0, 0, {"boom": (3.5,)}, {}))
    trouble = watch.trouble(6.1)
    assert trouble is not None and isinstance(trouble.reason, Beyond)


def test_a_machine_with_a_new_clock_stands_only_for_those_whom_this_does_not_matter() -> None:
    watch = machine()
    now = stands(watch)
    assert watch.standing(now)
    now = starts_its_clock_anew(watch, now)
    trouble = watch.trouble(now)
    assert trouble is not None and isinstance(trouble.reason, NewClock)
    assert not watch.standing(now) and watch.standing(now, passing=True)


def test_a_machine_that_two_report_does_not_stand() -> None:
    watch = machine()
    for i in range(21):
        tell(watch, JOINTS, PERIOD * i, {"boom": (0.0,), "arm": (0.0,)}, number=100 * (i % 2) + i)
    assert not watch.standing(1.0) and not watch.standing(1.0, passing=True)
    assert watch.obstacle(1.0) == TwoPublishers(JointStates())


def test_why_a_stop_is_not_proven_yet() -> None:
    watch = machine()
    now = stands(watch)
    assert watch.obstacle(now) == NotLongEnough()
    joints(watch, now + PERIOD, boom=0.1)
    assert watch.obstacle(now + PERIOD) == Moving()


def test_the_joint_that_went_furthest_is_told() -> None:
    watch = machine()
    joints(watch, 0.0)
    watch.mark()
    joints(watch, 0.1, boom=0.1, arm=0.25)
    joints(watch, 0.2)
    assert watch.travel() == Travel("arm", 0.25, 0.0)
