"""The chain tells what was changed, taken out, put in or exchanged, and where."""

from dataclasses import replace

import pytest

from tms_ur.audit_chain import LARGEST, AuditEntry, ChainCheck, ChainHead, Note, highest, tied
from tms_ur.strangers import MANY, MAX_KINDS, Strangers

CHAIN = tied(ChainHead(0, ""), [Note(1000 * number, "stop", "zx200", f"mina {number}") for number in range(6)])


def verdict(entries: list[AuditEntry], end: ChainHead | None = None) -> ChainCheck:
    made = ChainCheck()
    for one in entries:
        made.add(one)
    if end is not None:
        made.end(end)
    return made


def faults(entries: list[AuditEntry], end: ChainHead | None = None) -> list[tuple[int, int, str]]:
    return [(one.number, one.until, one.what) for one in verdict(entries, end).faults]


def test_an_intact_chain() -> None:
    found = verdict(CHAIN, ChainHead(6, CHAIN[-1].hash))
    assert (found.intact, found.chained, found.first, found.cut, found.older) == (True, 6, 1, False, 0)


@pytest.mark.parametrize(
    "change",
    [{"at": 1}, {"kind": "rearm"}, {"node": "ic120"}, {"text": "ken"}, {"times": 2}],
)  # fmt: skip
def test_a_changed_entry(change: dict[str, object]) -> None:
    wrong = replace(CHAIN[2], note=replace(CHAIN[2].note, **change))  # type: ignore[arg-type]
    assert faults([*CHAIN[:2], wrong, *CHAIN[3:]]) == [(3, 3, "changed")]


def test_one_that_was_changed_with_its_hash() -> None:
    made = tied(ChainHead(2, CHAIN[1].hash), [replace(CHAIN[2].note, text="ken")])
    assert faults([*CHAIN[:2], *made, *CHAIN[3:]]) == [(4, 4, "out_of_order")]


def test_missing_entries() -> None:
    assert faults([*CHAIN[:2], *CHAIN[4:]]) == [(3, 4, "missing")]


def test_exchanged_entries() -> None:
    one, other = replace(CHAIN[2], number=4), replace(CHAIN[3], number=3)
    assert [what for _, _, what in faults([*CHAIN[:2], other, one, *CHAIN[4:]])].count("changed") == 2


def test_an_end_that_was_cut_off() -> None:
    assert faults(CHAIN[:4], ChainHead(6, CHAIN[-1].hash)) == [(5, 6, "missing")]
    assert faults([], ChainHead(6, CHAIN[-1].hash)) == [(1, 6, "missing")]
    assert faults(CHAIN, ChainHead(6, "another")) == [(6, 6, "changed")]


def test_a_beginning_that_was_deleted_for_its_age() -> None:
    found = verdict(CHAIN[3:])
    assert (found.intact, found.first, found.cut) == (True, 4, True)


def test_entries_without_a_hash() -> None:
    old = [AuditEntry(number, Note(0, "stop", "", ""), "", "") for number in (3, 90)]
    ours = tied(ChainHead(90, ""), [Note(1, "stop", "a", ""), Note(2, "stop", "b", "")])
    found = verdict([*old, *ours])
    assert (found.intact, found.older, found.first, found.cut) == (True, 2, 91, False)
    put_in = AuditEntry(93, Note(3, "stop", "c", ""), "", "")
    assert faults([*ours, put_in]) == [(93, 93, "no_hash")]


def test_many_faults_are_counted_and_some_named() -> None:
    wrong = [replace(one, hash="0") for one in tied(ChainHead(0, ""), [Note(0, "stop", "", "")] * 50)]
    found = verdict(wrong)
    assert found.found >= 50
    assert len(found.faults) == 20


@pytest.mark.parametrize("number", [0, 1, 2, 1_790_000_000, LARGEST])
def test_the_highest_number_is_found(number: int) -> None:
    asked: list[int] = []

    def is_any_after(after: int) -> bool:
        asked.append(after)
        return after < number

    assert highest(is_any_after) == number
    assert len(asked) <= 33


def test_strangers_need_no_more_memory_the_more_there_are() -> None:
    now = [0.0]
    strangers = Strangers(lambda: now[0])
    first = [strangers.add("-", f"192.0.{n // 250}.{n % 250}", "refused", "LOGIN") for n in range(5000)]
    assert sum(first) == MAX_KINDS + 1  # and one for all others together
    assert strangers.due() == []
    now[0] = 61.0
    (others,) = strangers.due()
    assert (others.source, others.times) == (MANY, 5000 - MAX_KINDS - 1)
    now[0] = 122.0
    assert strangers.due() == []
    assert strangers.add("-", "192.0.2.1", "refused", "LOGIN")  # a minute without any: the next one is told at once


def test_a_stranger_is_told_of_once_a_minute() -> None:
    now = [0.0]
    strangers = Strangers(lambda: now[0])
    reported = []
    for second in range(300):
        now[0] = float(second)
        reported += ["first"] * strangers.add("-", "192.0.2.1", "refused", "LOGIN")
        reported += [one.times for one in strangers.due()]  # type: ignore[misc]
    assert reported == ["first", 60, 60, 60, 60]
