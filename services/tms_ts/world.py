"""The interface of leaf nodes to the outside. Every call returns at once: a leaf asks, and reads the answer later."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol, TypeVar

from tms_config.clock import monotonic
from tms_decision.leaf.state import GoalState
from tms_reason.reason import Reason

Value = str | bool | int | float
ARRAY_CHANGES = ("add", "push", "remove", "reset")  # words of SharedFlags.change_array
T_co = TypeVar("T_co", covariant=True)


class Goal(Protocol):
    """One goal sent to a subtask."""

    @property
    def state(self) -> GoalState: ...

    @property
    def reason(self) -> Reason | None: ...  # why it waits or ended

    @property
    def feedback(self) -> Reason | None: ...  # the subtask's last feedback

    def cancel(self) -> None: ...


class Machines(Protocol):
    """What a tree asks of machines."""

    def send(self, machine: str, subtask: str, record: str, node: str) -> Goal:
        """Send a goal; `node` is the node's path, for the journal.

        `record` is the record's name, with the goal's inputs behind it (tms_machine.goal_inputs).
        """
        ...


class Pending(Protocol[T_co]):
    """An answer that may not be there yet."""

    @property
    def done(self) -> bool: ...

    @property
    def value(self) -> T_co: ...  # when done without error

    @property
    def error(self) -> Reason | None: ...


class SharedFlags(Protocol):
    """Parameter records that several tasks read and write."""

    def read(self, record: str, field: str) -> Pending[Any]: ...

    def write(self, record: str, field: str, value: Value, expected: Value | None = None) -> Pending[None]:
        """`expected`: the field must hold this value, or nothing is written and the answer is an error."""
        ...

    def change_array(self, record: str, field: str, change: str, value: Value) -> Pending[None]:
        """`change`: one of ARRAY_CHANGES; adds the value unless it is there, puts it last, takes it out, or empties."""
        ...

    def find(self, values: Mapping[str, Value]) -> Pending[bool]:
        """Whether a record of any machine, or a shared one, has all these values."""
        ...


class Clicks(Protocol):
    """Questions to the operator."""

    def ask(self, title: str, text: str, node: str, seconds: float | None) -> Pending[bool]:
        """Show a question; `node` is the path of the node, `seconds` its time-out from now, None if it has none."""
        ...

    def withdraw(self, question: Pending[bool]) -> None: ...


class SharedPlaces(Protocol):
    """Release areas, which one machine holds at a time."""

    def hold(self, machine: str, place: str) -> Pending[None]:
        """Want a place for a machine; answered once the keeper has noted it."""
        ...

    def free(self, machine: str, place: str) -> Pending[None]:
        """Want it no more."""
        ...

    def waits(self, machine: str, place: str) -> Reason | None:
        """Why a machine that wants a place must not go there yet; None: it holds it."""
        ...


@dataclass(slots=True)
class World:
    """Everything outside the tree that its nodes use."""

    machines: Machines
    flags: SharedFlags
    clicks: Clicks
    places: SharedPlaces
    clock: Callable[[], float] = monotonic  # s
