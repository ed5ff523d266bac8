"""Stand-ins in memory for everything a tree asks of the outside."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Generic, TypeVar

from tms_reason.reason import Foreign, Reason
from tms_ts.world import GoalState, Value, World

T = TypeVar("T")


@dataclass
class Answer(Generic[T]):
    """A question's answer; `done` may be set later."""

    value: Any = None
    done: bool = True
    error: Reason | None = None


@dataclass
class FakeGoal:
    """Succeeds at the `lasts`-th look at it (the first look is the one right after sending)."""

    machine: str
    subtask: str
    record: str
    node: str
    lasts: int = 3
    end: GoalState = GoalState.SUCCEEDED
    reason: Reason | None = None
    feedback: Reason = field(default_factory=lambda: Foreign("on the way"))
    cancels: int = 0
    looks: int = 0

    @property
    def state(self) -> GoalState:
        self.looks += 1
        return GoalState.RUNNING if self.looks < self.lasts else self.end

    def cancel(self) -> None:
        self.cancels += 1


@dataclass
class FakeMachines:
    sent: list[FakeGoal] = field(default_factory=list)
    lasts: int = 3
    end: GoalState = GoalState.SUCCEEDED

    def send(self, machine: str, subtask: str, record: str, node: str) -> FakeGoal:
        goal = FakeGoal(machine, subtask, record, node, self.lasts, self.end)
        self.sent.append(goal)
        return goal


@dataclass
class FakeFlags:
    """Flags in memory, false if never written; answers come at once unless `slow`."""

    values: dict[tuple[str, str], Any] = field(default_factory=dict)
    writes: list[tuple[str, str, Value]] = field(default_factory=list)
    slow: bool = False
    missing: set[str] = field(default_factory=set)  # records that are not there
    open: list[Answer[Any]] = field(default_factory=list)
    reads: int = 0
    searches: list[dict[str, Value]] = field(default_factory=list)

    def read(self, record: str, field: str) -> Answer[Any]:
        self.reads += 1
        return self._answer(record, self.values.get((record, field), False))

    def write(self, record: str, field: str, value: Value, expected: Value | None = None) -> Answer[None]:
        if expected is not None and self.values.get((record, field), False) != expected:
            return Answer(error=Foreign("the field holds another value"))
        if record not in self.missing:
            self.values[record, field] = value
            self.writes.append((record, field, value))
        return self._answer(record, None)

    def change_array(self, record: str, field: str, change: str, value: Value) -> Answer[None]:
        array = self.values.get((record, field), [])
        if not isinstance(array, list):
            return Answer(error=Foreign("the field is no array"))
        changes = {
            "add": [*array, *([] if value in array else [value])],
            "push": [*array, value],
            "remove": [one for one in array if one != value],
            "reset": [],
        }
        return self.write(record, field, changes[change])

    def find(self, values: Mapping[str, Value]) -> Answer[bool]:
        self.searches.append(dict(values))
        records = {record for record, _ in self.values} - self.missing
        found = [one for one in records if all(_same(self.values.get((one, name)), values[name]) for name in values)]
        return self._answer("", bool(found))

    def _answer(self, record: str, value: Any) -> Answer[Any]:
        answer: Answer[Any] = Answer(value, done=not self.slow)
        if record in self.missing:
            answer.error = f"there is no record {record}"
        if self.slow:
            self.open.append(answer)
        return answer

    def answer_all(self) -> None:
        for answer in self.open:
            answer.done = True
        self.open.clear()


def _same(stored: Any, wanted: Value) -> bool:
    """As the store compares: true is not 1, but 1 is 1.0."""
    return bool(stored == wanted) and isinstance(stored, bool) == isinstance(wanted, bool)


@dataclass
class FakeClicks:
    answer: bool | None = True  # None: nobody clicks
    asked: list[tuple[str, str]] = field(default_factory=list)
    times: list[float | None] = field(default_factory=list)
    withdrawn: int = 0

    def ask(self, title: str, text: str, node: str, seconds: float | None) -> Answer[bool]:
        self.asked.append((title, text))
        self.times.append(seconds)
        return Answer(self.answer, done=self.answer is not None)

    def withdraw(self, question: Any) -> None:
        self.withdrawn += 1


@dataclass
class Clock:
    now: float = 0.0

    def __call__(self) -> float:
        return self.now


@dataclass
class FakePlaces:
    """Lets go who is not told to wait."""

    why: Reason | None = None
    refusal: Reason | None = None
    calls: list[tuple[str, str, str]] = field(default_factory=list)

    def hold(self, machine: str, place: str) -> Answer[None]:
        self.calls.append(("hold", machine, place))
        return Answer(error=self.refusal)

    def free(self, machine: str, place: str) -> Answer[None]:
        self.calls.append(("free", machine, place))
        return Answer(error=self.refusal)

    def waits(self, machine: str, place: str) -> Reason | None:
        return self.why


@dataclass
class FakeWorld:
    machines: FakeMachines = field(default_factory=FakeMachines)
    flags: FakeFlags = field(default_factory=FakeFlags)
    clicks: FakeClicks = field(default_factory=FakeClicks)
    places: FakePlaces = field(default_factory=FakePlaces)
    clock: Clock = field(default_factory=Clock)

    def world(self) -> World:
        return World(self.machines, self.flags, self.clicks, self.places, self.clock)
