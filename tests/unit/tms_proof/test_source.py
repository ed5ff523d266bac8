"""One source of a machine: when it is silent, when it cannot be believed, and what it tells of the way."""

import pytest

from tms_proof.channel import Limits
from tms_proof.facts import SourceFacts, Stamps
from tms_proof.reasons import (
    Implausible,
    JointStates,
    NewClock,
    Old,
    OldOf,
    PositionsMove,
    StampRepeated,
    TwoPublishers,
)
from tms_proof.source import MIXED, SETTLED, SourceSample, SourceWatch

TOPIC = "/zx200/joint_states"
LONGEST = 0.75  # s without a new stamp


class Told:
    """A source of some joints, and what is received of them."""

    def __init__(self, *joints: str, stamps: Stamps = "utc", turns: bool = False) -> None:
        facts = SourceFacts(LONGEST / 3, stamps, 2.0, TOPIC)
        self.watch = SourceWatch("joint_states", facts, {name: Limits(0.25, turns=turns) for name in joints})
        self.number = 0

    def take(
        self, at: float, angle: float = 0.0, speed: float = 0.0, stamp: float | None = None, number: int | None = None,
        of: tuple[str, ...] | None = None,
    ) -> None:  # fmt: skip
        self.number = self.number + 1 if number is None else number
        names = tuple(self.watch.channels) if of is None else of
        stamp = at if stamp is None else stamp
        self.watch.take(
            SourceSample(at, stamp, self.number, dict.fromkeys(names, (angle,)), dict.fromkeys(names, speed))
        )

    def why(self, now: float) -> object:
        trouble = self.watch.trouble(now)
        return trouble and trouble.reason


def test_a_source_of_which_nothing_was_heard() -> None:
    watch = Told("boom").watch
    assert watch.fast is False and watch.publishers == () and watch.places() == {}
    assert watch.changed == float("-inf") and watch.age(5.0) == float("inf")


def test_a_source_without_any_joint_is_never_heard() -> None:
    assert Told().watch.age(5.0) == float("inf")


def test_its_age_is_that_of_the_joint_that_is_silent_for_longest() -> None:
    told = Told("boom", "arm")
    told.take(1.0)
    told.take(3.0, of=("arm",))
    assert told.watch.age(3.5) == 2.5


def test_a_source_is_silent_after_the_limit() -> None:
    told = Told("boom")
    told.take(1.0)
    assert told.watch.silent(1.5, 0.5) is None
    assert told.watch.silent(1.75, 0.5) == Old(JointStates(), 0.75, TOPIC)


def test_a_joint_that_is_silent_is_named() -> None:
    told = Told("boom", "arm")
    told.take(1.0)
    told.take(2.0, of=("boom",))
    assert told.watch.silent(2.0, 0.5) == OldOf(JointStates(), "arm", 1.0, TOPIC)


def test_a_proof_needs_news_up_to_the_longest_pause() -> None:
    told = Told("boom")
    told.take(0.0)
    told.take(0.25)
    assert told.watch.proves(-1.0, 0.25 + LONGEST, 0.25)
    assert not told.watch.proves(-1.0, 0.26 + LONGEST, 0.25)
    told.watch.publishers = ("/driver", "/stranger")
    assert not told.watch.proves(-1.0, 0.25, 0.25)


# two publishers


def numbered(*numbers: int) -> Told:
    told = Told("boom")
    for i, number in enumerate(numbers):
        told.take(0.25 * i, number=number)
    return told


def test_a_driver_that_does_not_number_its_messages_is_one() -> None:
    assert numbered(0, 0, 0, 0).why(1.0) is None


@pytest.mark.parametrize("numbers", [(1, 1, 1), (9, 3, 10, 4), (9, 8, 7, 6)])
def test_numbers_that_do_not_go_on_are_those_of_two(numbers: tuple[int, ...]) -> None:
    assert numbered(*numbers).why(1.0) == TwoPublishers(JointStates())


def test_publishers_that_were_started_again_now_and_then_are_one() -> None:
    told = Told("boom")
    for at, number in ((0.0, 9), (1.0, 1), (1.0 + MIXED, 0)):
        told.take(at, number=number)
    assert told.why(1.0 + MIXED) is None
    assert told.why(0.9 + MIXED) == TwoPublishers(JointStates())


# stamps


def repeated(*times: float) -> Told:
    told = Told("boom")
    told.take(0.0, stamp=5.0)
    for at in times:
        told.take(at, stamp=5.0)
    return told


def test_a_stamp_that_stands_still_is_told_while_it_does() -> None:
    assert repeated(1.0, 1.25, 1.5).why(1.5) == StampRepeated(JointStates())
    assert repeated(1.0, 1.25).why(1.5) is None
    assert repeated(1.0, 1.25, 1.5).why(1.0 + MIXED) is None


def test_a_new_clock_is_accepted_after_a_while_of_standing() -> None:
    told = Told("boom", stamps="since_start")
    told.watch.settle(0.0, stands=False)
    assert told.watch.new_clock is None
    told.take(1.0, stamp=50.0)
    told.take(1.25, stamp=0.25)
    assert isinstance(told.why(1.25), NewClock)
    told.watch.settle(2.0, stands=False)
    told.watch.settle(1.75 + SETTLED, stands=True)
    assert isinstance(told.why(1.75 + SETTLED), NewClock)
    told.watch.settle(2.0 + SETTLED, stands=True)
    assert told.why(2.0 + SETTLED) is None


# what the joints do


def test_a_joint_that_contradicts_itself_is_named() -> None:
    told = Told("boom", "arm")
    for i in range(4):
        told.take(0.125 * i, of=("boom",))
        told.take(0.125 * i + 0.01, angle=0.125 * i, of=("arm",))
    assert told.why(0.5) == Implausible(JointStates(), "arm", PositionsMove())


def test_the_way_of_a_joint_that_turns_is_the_shorter_one() -> None:
    told = Told("swing", turns=True)
    told.take(0.0, angle=3.1)
    marks = told.watch.places()
    told.take(1.0, angle=-3.1)
    assert told.watch.travel(marks) == {"swing": pytest.approx(0.0831853)}
    assert told.watch.travel({}) == {}
