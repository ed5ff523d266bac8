"""The chain of the audit's entries: each carries the hash of the one before and its own. Pure logic.

`tms audit verify` finds by it an entry that was changed, removed or inserted afterwards. It cannot find that the whole
rest of the chain was made anew.
"""

import hashlib
import json
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any, Literal

RUN = "audit"  # the entries are the journal of this run
MAX_FAULTS = 20  # faults that a report names
LARGEST = 2**32 - 1  # number of an entry

Document = dict[str, Any]
Value = bool | int | float | str | list[bool] | list[int] | list[float] | list[str] | Document | list[Document]


@dataclass(frozen=True)
class Note:
    """A command or refusal to record, before it has a place in the chain."""

    at: int  # ms since 1970
    kind: str
    node: str  # target of the command
    text: str  # person and address
    times: int = 1


@dataclass(frozen=True)
class ChainHead:
    """Number and hash of the last entry, to which the next one is tied."""

    number: int
    hash: str  # empty: the entry is older than the chain, or there is none


@dataclass(frozen=True)
class AuditEntry:
    """A note with its place."""

    number: int
    note: Note
    previous: str
    hash: str  # as stored; empty in entries that are older than the chain

    def right_hash(self) -> str:
        """The hash of its content."""
        note = self.note
        content = [self.number, note.at, note.kind, note.node, note.text, note.times, self.previous]
        return hashlib.sha256(json.dumps(content, separators=(",", ":")).encode()).hexdigest()

    def values(self) -> dict[str, Value]:
        """The stored values, apart from the fields that every event has."""
        return {"times": self.note.times, "previous": self.previous, "hash": self.hash}


def entry(number: int, note: Note, values: dict[str, Value]) -> AuditEntry:
    """An entry from its stored number, note and values."""
    times = values.get("times", 1)
    return AuditEntry(
        number, Note(note.at, note.kind, note.node, note.text, times if isinstance(times, int) else 0),
        str(values.get("previous", "")), str(values.get("hash", "")),
    )  # fmt: skip


def tied(last: ChainHead, notes: Iterable[Note]) -> list[AuditEntry]:
    """The entries for notes after `last`; the same arguments give the same entries."""
    made: list[AuditEntry] = []
    for note in notes:
        bare = AuditEntry(last.number + 1, note, last.hash, "")
        made.append(AuditEntry(bare.number, note, bare.previous, bare.right_hash()))
        last = ChainHead(made[-1].number, made[-1].hash)
    return made


def highest(is_any_after: Callable[[int], bool]) -> int:
    """The highest number that is stored, 0 if there is none; calls `is_any_after` some 32 times."""
    low, high = 0, LARGEST  # no entry has a number above `high`
    while low < high:
        middle = (low + high) // 2
        if is_any_after(middle):
            low = middle + 1
        else:
            high = middle
    return low


@dataclass(frozen=True)
class ChainFault:
    """A fault at an entry."""

    number: int
    what: Literal["missing", "changed", "out_of_order", "no_hash"]
    until: int  # the last missing number; for other faults the same number


@dataclass
class ChainCheck:
    """Checks the entries in the order of their numbers."""

    older: int = 0  # entries that are older than the chain
    chained: int = 0
    first: int = 0  # number of the chain's first entry
    cut: bool = False  # whether entries before the first one have been deleted
    faults: list[ChainFault] = field(default_factory=list)
    found: int = 0  # number of faults; `faults` holds the first ones
    last: ChainHead = field(default_factory=lambda: ChainHead(0, ""))

    @property
    def intact(self) -> bool:
        return self.found == 0

    def add(self, one: AuditEntry) -> None:
        """Check the next entry."""
        if not one.hash and not self.chained:
            self.older += 1
        elif not self.chained:
            self.first, self.cut = one.number, bool(one.previous)
            self._compare(one)
        else:
            if one.number > self.last.number + 1:
                self._fault(self.last.number + 1, "missing", one.number - 1)
            elif one.hash and one.previous != self.last.hash:
                self._fault(one.number, "out_of_order")
            self._compare(one)
        self.last = ChainHead(one.number, one.hash)

    def end(self, reported: ChainHead) -> None:
        """Compare the end of the chain with the last stored entry that the console's PC remembers."""
        if reported.number > self.last.number:
            self._fault(self.last.number + 1, "missing", reported.number)
        elif reported.number == self.last.number and reported.hash != self.last.hash:
            self._fault(reported.number, "changed")

    def _compare(self, one: AuditEntry) -> None:
        self.chained += 1
        if not one.hash:
            self._fault(one.number, "no_hash")
        elif one.hash != one.right_hash():
            self._fault(one.number, "changed")

    def _fault(
        self, number: int, what: Literal["missing", "changed", "out_of_order", "no_hash"], until: int = 0
    ) -> None:
        self.found += 1
        if len(self.faults) < MAX_FAULTS:
            self.faults.append(ChainFault(number, what, until or number))
