"""The newest value of each record reaches the database, whatever fails on the way."""

from collections import defaultdict

from tms_reason.reason import Foreign
from tms_sp.outbox import RECORDS, Counts, InputUpdate, Outbox


def outbox() -> tuple[Outbox, Counts]:
    counts: dict[str, Counts] = defaultdict(Counts)
    return Outbox(lambda name: counts[name]), counts["input"]


def update(record: str, value: float) -> InputUpdate:
    return InputUpdate("input", ("zx200", record), {"x": value}, 0.0)


def values(updates: list[InputUpdate]) -> dict[str, float]:
    return {one.key[1]: one.values["x"] for one in updates}


def test_the_newest_of_each_record_is_sent() -> None:
    box, counts = outbox()
    for one in (update("a", 1.0), update("b", 1.0), update("a", 2.0)):
        assert box.put(one)
    number, updates = box.take()
    assert values(updates) == {"a": 2.0, "b": 1.0}
    assert not box.ready
    box.stored(number, [(1, "RECORD_MISSING", Foreign("there is no record"))])
    assert (counts.written, counts.superseded) == (1, 1)
    assert counts.unwanted == [("RECORD_MISSING", Foreign("there is no record"))]


def test_what_failed_is_sent_again_unless_something_newer_is_there() -> None:
    box, counts = outbox()
    box.put(update("a", 1.0))
    box.put(update("b", 1.0))
    number, _ = box.take()
    box.put(update("a", 2.0))
    box.failed(number)
    assert values(box.take()[1]) == {"a": 2.0, "b": 1.0}
    assert counts.superseded == 1


def test_an_old_value_never_follows_a_newer_one_that_was_stored() -> None:
    box, counts = outbox()
    box.put(update("a", 1.0))
    first, _ = box.take()
    box.put(update("a", 2.0))
    second, _ = box.take()
    box.stored(second, [])
    box.failed(first)
    assert not box.ready
    assert (counts.written, counts.superseded) == (1, 1)


def test_it_is_bounded() -> None:
    box, _ = outbox()
    assert all(box.put(update(str(number), 0.0)) for number in range(RECORDS))
    assert not box.put(update("more", 0.0))
    assert box.put(update("1", 1.0))
