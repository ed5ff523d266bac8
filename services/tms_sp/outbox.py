"""Queue of the newest values of each record for the database: bounded, and sent again until they are stored."""

import itertools
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any

from tms_reason.reason import Reason

RECORDS = 5000  # records whose values may wait at the same time
BATCH = 200  # updates in one request
FLIGHTS = 90  # requests without an answer, fewer than a service keeps: a slow store takes a second to acknowledge


@dataclass(frozen=True)
class InputUpdate:
    """New values for a record from one input."""

    source: str  # name of the input
    key: tuple[str, str]  # model, record
    values: dict[str, Any]
    measured: float  # s, monotonic clock of this PC
    keep: tuple[str, ...] = ()


@dataclass
class Counts:
    """Counts of one input."""

    written: int = 0
    superseded: int = 0
    unwanted: list[tuple[str, Reason]] = field(default_factory=list)  # code and reason of the database's refusals


Place = tuple[str, str, str]


class Outbox:
    """Used on one thread."""

    def __init__(self, counts: Callable[[str], Counts]) -> None:
        self._counts = counts
        self._waiting: dict[Place, InputUpdate] = {}
        self._flights: dict[int, list[InputUpdate]] = {}
        self._last: dict[Place, int] = {}  # number of the batch with the newest sent values
        self._numbers = itertools.count()

    def put(self, update: InputUpdate) -> bool:
        """Take values; they replace older waiting ones of the same record. Returns False when too many records wait."""
        place = _place(update)
        if place in self._waiting:
            self._counts(update.source).superseded += 1
        elif len(self._waiting) >= RECORDS:
            return False
        self._waiting[place] = update
        return True

    @property
    def ready(self) -> bool:
        """Whether a batch can be sent now."""
        return bool(self._waiting) and len(self._flights) < FLIGHTS

    def take(self) -> tuple[int, list[InputUpdate]]:
        """A batch to send, oldest first, and its number."""
        places = list(itertools.islice(self._waiting, BATCH))
        number = next(self._numbers)
        self._flights[number] = [self._waiting.pop(place) for place in places]
        self._last.update(dict.fromkeys(places, number))
        return number, self._flights[number]

    def stored(self, number: int, refused: Iterable[tuple[int, str, Reason]]) -> None:
        """Note that a batch is stored, except for the refused updates: index, code and reason of each."""
        updates = self._flights.pop(number, [])
        unwanted = {index: (code, why) for index, code, why in refused}
        for index, update in enumerate(updates):
            if index in unwanted:
                self._counts(update.source).unwanted.append(unwanted[index])
            else:
                self._counts(update.source).written += 1

    def failed(self, number: int) -> None:
        """Queue a batch again, except for values that newer ones replace: it is not known whether it was stored."""
        again: dict[Place, InputUpdate] = {}
        for update in self._flights.pop(number, []):
            place = _place(update)
            if place in self._waiting or self._last[place] > number:
                self._counts(update.source).superseded += 1
            else:
                again[place] = update
        self._waiting = {**again, **self._waiting}


def _place(update: InputUpdate) -> Place:
    return update.source, *update.key
