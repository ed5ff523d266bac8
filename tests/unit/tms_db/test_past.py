"""The memory of a record's changes fits into one document of the store, however large they are."""

from datetime import datetime, timezone
from typing import Any

import bson
import pytest
import structlog

from tms_db.parameter_history import KEPT, ROOM, ParameterHistory

NOON = datetime(2026, 1, 31, 12, 0, tzinfo=timezone.utc)
KEY = ("zx200", "path")
LARGEST = 16 * 2**20  # bytes that the store takes


class Stored:
    """The changes of one document, pushed as the store does it."""

    def __init__(self) -> None:
        self.changes: list[Any] = []

    def __getitem__(self, _: str) -> "Stored":
        return self

    def bulk_write(self, steps: list[Any], ordered: bool) -> None:
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
