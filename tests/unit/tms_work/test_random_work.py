"""Random work: nothing is counted twice or lost, parts fill their cycle, a kept state changes nothing."""

import json
from dataclasses import dataclass, field

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tms_work.cycle import Cycle
from tms_work.recogniser import Recogniser
from tms_work.sample import Sample
from tms_work.ways import EXCAVATOR
from work_rig import HEAPED, Tape, amount, taken


@dataclass
class Work:
    """What an excavator did, and what it really dumped."""

    tape: Tape = field(default_factory=Tape)
    dumped: float = 0.0  # m3, loose
    buckets: int = 0


TRUCKS = st.sampled_from(["", "ic120_1", "ic120_2"])
FEW, SECONDS = st.floats(0.4, 3), st.floats(0.4, 8)


@st.composite
def works(draw: st.DrawFn) -> Work:
    work = Work()
    for _ in range(draw(st.integers(1, 4))):
        work.tape.kept["run"] = draw(st.sampled_from(["r1", "r1", "r2"]))
        dig_and_dump(draw, work)
    return work


def dig_and_dump(draw: st.DrawFn, work: Work) -> None:
    tape = work.tape
    if draw(st.booleans()):  # aborted: it falls back
        tape.go(draw(FEW), tape.loose + draw(st.floats(0.2, 0.5)), cuts=True).go(draw(FEW), 0.0)
    tape.go(draw(FEW), tape.loose + draw(st.floats(0.3, 0.9)), cuts=True)
    tape.go(draw(SECONDS), swing=0.5)
    befalls(draw, tape)
    if draw(st.booleans()):  # spilled on the way
        tape.go(0.4, tape.loose * draw(st.floats(0.8, 0.95)), swing=0.5).go(1, swing=0.5)
    rest = draw(st.sampled_from([0.0, 0.0, 0.02]))
    work.dumped += tape.loose - rest
    work.buckets += 1
    truck = draw(TRUCKS)
    if draw(st.booleans()):  # in two goes
        tape.go(0.6, rest + (tape.loose - rest) / 2, under=truck).go(draw(FEW), under=truck)
    tape.go(draw(FEW), rest, under=truck).go(draw(SECONDS), swing=-0.5)


def befalls(draw: st.DrawFn, tape: Tape) -> None:
    """A wait, a stop, a silence, a clock that goes back, or nothing."""
    what = draw(st.sampled_from(["", "wait", "stop", "silence", "back"]))
    if what == "wait":
        tape.go(draw(SECONDS), moves=False)
    elif what == "stop":
        tape.go(draw(SECONDS), moves=False, stopped=True)
    elif what:
        tape.time += draw(st.floats(10, 5000)) * (1 if what == "silence" else -1)
        tape.go(1, swing=0.5)


def cycles(samples: list[Sample]) -> list[Cycle]:
    return taken(Recogniser("zx200", EXCAVATOR, HEAPED), samples)


@settings(max_examples=40, deadline=None)
@given(works())
def test_the_cycles_hold_what_was_dumped_each_bucket_once(work: Work) -> None:
    found = cycles(work.tape.samples)
    assert len(found) == work.buckets
    sums = [sum(one.mass for one in found), sum(one.bank for one in found), sum(one.loose for one in found)]
    assert sums == pytest.approx(list(amount(work.dumped)))
    numbers = [(one.run_id, one.number) for one in found]
    assert len(set(numbers)) == len(numbers)


@settings(max_examples=20, deadline=None)
@given(works())
def test_parts_fill_their_cycle(work: Work) -> None:
    for one in cycles(work.tape.samples):
        assert sum(one.parts.values()) + one.unseen == pytest.approx(one.seconds, abs=1e-4)


@settings(max_examples=20, deadline=None)
@given(works(), st.floats(0, 1), st.integers(0, 20))
def test_a_kept_state_goes_on_as_if_nothing_had_happened(work: Work, share: float, again: int) -> None:
    samples = work.tape.samples
    at = round(share * len(samples))
    first, second = (Recogniser("zx200", EXCAVATOR, HEAPED) for _ in range(2))
    found = taken(first, samples[:at])
    second.restore(json.loads(json.dumps(first.state())))
    # What came last comes again after a restart.
    whole = found + taken(second, samples[max(0, at - min(again, tail(samples[:at]))) :])
    assert whole == cycles(samples)


def tail(samples: list[Sample]) -> int:
    """How many of the last samples follow each other in time."""
    count = 0
    while count + 1 < len(samples) and 0 < samples[-1 - count].time - samples[-2 - count].time < 1:
        count += 1
    return count
