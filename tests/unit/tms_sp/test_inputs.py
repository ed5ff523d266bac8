"""One input: stamps, the rate, and what is told of it. No node, messages are whatever has fields."""

import time
from types import SimpleNamespace as Message
from typing import Any

import pytest
from prometheus_client import REGISTRY

from tms_machine.sensing import Input
from tms_reason import wire
from tms_reason.reason import Foreign
from tms_reason.wire import to_line
from tms_sp.inputs import SensingInput
from tms_sp.mapping import Mapping
from tms_sp.outbox import InputUpdate
from tms_sp.reasons import MeasuredEarlier

FIELDS = {"header": "std_msgs/Header", "x": "double"}


class Heard:
    def __init__(self, **given: Any) -> None:
        wanted = {"topic": "/t", "type": "a/msg/B", "model": "m", "record": "r", "fields": {"x": "x"}, **given}
        self.updates: list[InputUpdate] = []
        self.full = False
        parsed = Input.model_validate(wanted)
        self.input = SensingInput("one", parsed, Mapping(parsed, FIELDS, {}.__getitem__), 0.5, self.put)

    def put(self, update: InputUpdate) -> bool:
        self.updates.append(update)
        return not self.full

    def say(self, x: float, stamp: float) -> str:
        """What became of a message."""
        before = self.input.refused
        self.input.receive(Message(header=Message(stamp=Message(sec=int(stamp), nanosec=int(stamp % 1 * 1e9))), x=x))
        if self.input.refused == before:
            return "accepted"
        assert self.input.last_refusal is not None
        return self.input.last_refusal.code


def test_stamps_from_the_future_and_older_ones_are_refused() -> None:
    received, now = Heard(), time.time()
    assert received.say(1.0, now) == "accepted"
    assert received.say(2.0, now + 60) == "STAMP_IN_FUTURE"
    assert received.say(3.0, now - 1) == "MEASURED_EARLIER"
    assert received.say(4.0, now + 0.1) == "accepted"
    assert [update.values["x"] for update in received.updates] == [1.0, 4.0]
    state = received.input.state()
    assert (state.accepted, state.refused, state.state, list(state.records)) == (2, 2, "alive", ["m/r"])
    found = wire.known(state.last_refusal).find(MeasuredEarlier)
    assert found is not None and 1.0 <= found.seconds < 1.1


def test_a_source_whose_clock_is_behind_is_told_and_its_delay_counts_as_age() -> None:
    received, now = Heard(), time.time()
    received.say(1.0, now - 5)
    received.say(2.0, now - 5 - 0.0)
    assert received.input.state().state == "clock"
    assert received.input.state().clock_offset == pytest.approx(5.0, abs=0.5)
    assert time.monotonic() - received.updates[0].measured < 2.0


def test_what_comes_faster_than_wanted_is_left_out() -> None:
    received, now = Heard(max_hz=1.0), time.time()
    for step in range(5):
        received.say(float(step), now + step * 0.01)
    assert [update.values["x"] for update in received.updates] == [0.0]
    assert received.input.refused == 0


def test_waiting_and_too_much() -> None:
    received = Heard(hz=10.0)
    assert received.input.state().state == "waiting"
    received.full = True
    assert received.say(1.0, time.time()) == "MANY_WAIT"
    received.input.counts.unwanted.append(("RECORD_MISSING", Foreign("there is no record m/r")))
    assert received.input.state().last_refusal == to_line(Foreign("there is no record m/r"))


def test_the_metrics_tell_the_age_and_when_it_is_too_old() -> None:
    def value(name: str) -> float | None:
        return REGISTRY.get_sample_value(name, {"input": "one"})

    received, now = Heard(hz=5.0), time.time()
    received.input._began -= 100.0
    assert value("tms_sp_input_age_seconds") == pytest.approx(100.0, abs=5.0)
    assert value("tms_sp_input_age_limit_seconds") == 2.0
    received.say(1.0, now)
    age = value("tms_sp_input_age_seconds")
    assert age is not None and age < 5.0


def test_after_our_clock_was_set_back_stamps_are_taken_again(monkeypatch: pytest.MonkeyPatch) -> None:
    received, now = Heard(), time.time()
    assert received.say(1.0, now) == "accepted"
    monkeypatch.setattr(time, "time", lambda: now - 3600)
    assert received.say(2.0, now) == "STAMP_IN_FUTURE"  # the source's clock was not
    assert received.say(3.0, now - 3599.9) == "accepted"
    assert received.say(4.0, now - 3600.5) == "MEASURED_EARLIER"
    assert [update.values["x"] for update in received.updates] == [1.0, 3.0]
