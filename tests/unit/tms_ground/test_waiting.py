"""Finished cycles wait for the disk, then for the database; none counts twice."""

from typing import Any

import pytest
import structlog
from tms_msg_db.srv import WriteMachineStates

from tms_db import messages
from tms_ground.delivery import Delivery
from tms_ground.waiting import LOST, Waiting
from tms_reason.errors import RosError
from tms_reason.reason import Foreign
from tms_work.cycle import Cycle
from tms_work.recogniser import Recogniser
from tms_work.ways import EXCAVATOR
from work_rig import HEAPED, Tape, bucket, taken


class FakeDb:
    """Stands in for `Ros`: stores what it is sent, but for requests that hold a bad cycle."""

    def __init__(self) -> None:
        self.bad: set[int] = set()
        self.away = False
        self.stored: list[Cycle] = []

    def call(self, _: Any, name: str, request: Any) -> Any:
        assert name == "/tms/db/write_machine_states"
        cycles = [messages.cycle(one) for one in request.states]
        if self.away:
            raise RosError(Foreign("no answer"))
        if self.bad & {one.number for one in cycles}:
            return WriteMachineStates.Response(error_code="BAD_CYCLE", error_msg="bad")
        self.stored += cycles
        return WriteMachineStates.Response()

    def numbers(self) -> list[int]:
        return [one.number for one in self.stored]


def made(count: int) -> list[Cycle]:
    tape = Tape()
    for _ in range(count):
        bucket(tape, 0.8)
    return taken(Recogniser("zx200", EXCAVATOR, HEAPED), tape.samples)


def delivery(db: Any, waiting: Waiting) -> Delivery:
    return Delivery(db, structlog.stdlib.get_logger("test"), waiting)


def keep(waiting: Waiting) -> str:
    waiting.kept(waiting.made)
    return waiting.state()


def test_nothing_is_sent_before_it_is_on_the_disk() -> None:
    db, waiting, cycles = FakeDb(), Waiting(), made(3)
    waiting.put(cycles[:2])
    number = waiting.made
    waiting.put(cycles[2:])
    delivery(db, waiting).send()
    assert db.stored == [] and waiting.unkept
    waiting.kept(number)
    delivery(db, waiting).send()
    assert db.stored == cycles[:2] and waiting.unkept
    keep(waiting)
    delivery(db, waiting).send()
    assert db.stored == cycles and not waiting.unkept


def test_a_restart_sends_what_its_file_holds() -> None:
    db, waiting, again = FakeDb(), Waiting(), Waiting()
    waiting.put(made(3))
    again.restore(keep(waiting))
    assert not again.unkept
    delivery(db, again).send()
    assert db.stored == made(3) and again.state() == "[]"


@pytest.mark.parametrize("kept", ["{}", "[1]", "[", '[{"run_id": ""}]'])
def test_a_file_that_holds_no_cycles_changes_nothing(kept: str) -> None:
    waiting = Waiting()
    with pytest.raises(ValueError):
        waiting.restore(kept)
    assert waiting.state() == "[]"


def test_a_database_that_is_away_is_told_once_and_gets_all_in_order() -> None:
    db, waiting = FakeDb(), Waiting()
    waiting.put(made(5))
    keep(waiting)
    db.away, one = True, delivery(db, waiting)
    with structlog.testing.capture_logs() as logs:
        for _ in range(3):
            one.send()
    assert [line["event"] for line in logs] == ["cycles_wait"]
    db.away = False
    one.send()
    assert db.numbers() == [1, 2, 3, 4, 5]
    db.away = True
    waiting.put(made(1))
    keep(waiting)
    with structlog.testing.capture_logs() as logs:
        one.send()
    assert [line["event"] for line in logs] == ["cycles_wait"], "it is told anew"


def test_a_cycle_that_is_refused_for_good_delays_no_other() -> None:
    db, waiting = FakeDb(), Waiting()
    db.bad, lost = {2}, LOST._value.get()
    waiting.put(made(4))
    keep(waiting)
    with structlog.testing.capture_logs() as logs:
        delivery(db, waiting).send()
    assert db.numbers() == [1, 3, 4] and LOST._value.get() == lost + 1
    assert [line["event"] for line in logs] == ["cycle_lost"]


def test_too_many_push_out_the_oldest_and_that_is_told() -> None:
    db, waiting, cycles = FakeDb(), Waiting(most=3), made(7)
    waiting.put(cycles[:3])
    keep(waiting)
    batch = waiting.batch(2)
    waiting.put(cycles[3:5])
    waiting.done(batch)  # its answer comes when both have made room
    with structlog.testing.capture_logs() as logs:
        delivery(db, waiting).send()
        delivery(db, waiting).send()
    (line,) = logs
    assert line["event"] == "cycles_lost" and line["reason"].lost == 2
    assert db.numbers() == [3], "the others are not on the disk yet"
    keep(waiting)
    waiting.put(cycles[5:])
    waiting.put(made(4))
    assert waiting.unkept and waiting.batch(9) == []
