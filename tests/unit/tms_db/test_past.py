"""The memory of a record's changes fits into one document of the store, however large they are."""

from contextlib import nullcontext
from datetime import datetime, timezone
from types import SimpleNamespace
from typing import Any

import bson
import pytest
import structlog

from tms_db.parameter_history import AT_ONCE, KEPT, PAUSE, ROOM, WRITE_PERIOD, ParameterHistory
from tms_db.reasons import NoStore
from tms_reason.errors import DbError

NOON = datetime(2026, 1, 31, 12, 0, tzinfo=timezone.utc)
KEY = ("zx200", "path")
LARGEST = 16 * 2**20  # bytes that the store takes


class Stored:
    """The changes of one document, pushed as the store does it."""

    def __init__(self) -> None:
        self.changes: list[Any] = []
        self.writes: list[int] = []  # documents of each

    def __getitem__(self, _: str) -> "Stored":
        return self

    def bulk_write(self, steps: list[Any], ordered: bool) -> None:
        self.writes.append(len(steps))
        for step in steps:
            push = step._doc["$push"]["changes"]
            self.changes = [*self.changes, *push["$each"]][push["$slice"] :]


def save(stored: Stored, *sizes: int) -> None:
    past: Any = ParameterHistory(stored, None, structlog.stdlib.get_logger("test"))  # type: ignore[arg-type]
    past._save({KEY: [{"stamp": NOON, "source": "sp", "values": {"x": "." * size}} for size in sizes]})


def test_small_changes_are_kept_up_to_their_number() -> None:
    stored = Stored()
    for _ in range(KEPT + 5):
        save(stored, 1000, 1000)
    assert len(stored.changes) == KEPT


@pytest.mark.parametrize("sizes", [[ROOM // 5] * 60, [ROOM // (1 + n) - 200 for n in range(60)]])
def test_large_ones_drive_out_the_oldest(sizes: list[int]) -> None:
    stored = Stored()
    for size in sizes:
        save(stored, size)
        assert len(bson.encode({"changes": stored.changes})) < LARGEST
        assert len(stored.changes[-1]["values"]["x"]) == size
    save(Stored(), *sizes)


def test_one_that_is_too_large_alone_is_left_out() -> None:
    stored = Stored()
    save(stored, 10)
    save(stored, ROOM)
    assert [len(change["values"]["x"]) for change in stored.changes] == [10]


def test_a_round_writes_few_records_at_once_and_the_last_one_all() -> None:
    stored, connection = Stored(), SimpleNamespace(use=nullcontext)
    past: Any = ParameterHistory(stored, connection, structlog.stdlib.get_logger("test"))  # type: ignore[arg-type]

    def note() -> None:
        for number in range(2 * AT_ONCE + 1):
            past.note(("zx200", f"r{number}"), NOON, "sp", {"x": number})

    note()
    assert [past._run() for _ in range(3)] == [PAUSE, PAUSE, WRITE_PERIOD]
    assert stored.writes == [AT_ONCE, AT_ONCE, 1] and not past._new
    note()
    past._run()
    note()  # the first ones anew, while others of the round still wait
    past.stop()
    past._run()
    assert stored.writes[3:] == [AT_ONCE, 2 * AT_ONCE + 1] and not past._new


def test_a_round_ends_when_the_store_is_away() -> None:
    def away() -> nullcontext[None]:
        raise DbError(NoStore())

    past: Any = ParameterHistory(Stored(), SimpleNamespace(use=away), structlog.stdlib.get_logger("test"))  # type: ignore[arg-type]
    for number in range(2 * AT_ONCE):
        past.note(("zx200", f"r{number}"), NOON, "sp", {"x": number})
    assert past._run() == WRITE_PERIOD
    assert len(past._new) == 2 * AT_ONCE
