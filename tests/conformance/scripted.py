"""The scripted leaves that the recorded cases use, and the setters SetInt, SetDouble and SetBool."""

from __future__ import annotations

from collections.abc import Generator
from typing import Any

from tms_ts.bt import (
    FAILURE,
    IDLE,
    MISSING,
    RUNNING,
    SUCCESS,
    Condition,
    CoroAction,
    In,
    Node,
    Out,
    PlainAction,
    Registry,
    StatefulAction,
    Status,
    SyncAction,
    registry,
)

LETTERS = {"R": RUNNING, "S": SUCCESS, "F": FAILURE, "I": IDLE}
events: list[tuple[Any, ...]] = []  # (node, event, letter[, value read])


class Scripted(Node):
    script: In[str]
    in_: In[str]
    val: In[str]
    out: Out[str]

    def prepare(self) -> None:
        super().prepare()
        self.position = 0
        self.letters: str | None = None

    def letter(self) -> str:
        if self.letters is None:
            text = self.read("script")
            self.letters = text if isinstance(text, str) and text else "S"
        stays = self.letters.endswith("+")
        letters = self.letters.removesuffix("+") or "S"
        taken = letters[min(self.position, len(letters) - 1) if stays else self.position % len(letters)]
        self.position += 1
        return taken

    def execute(self, event: str) -> Status:
        letter = self.letter()
        record: tuple[Any, ...] = (self, event, letter)
        if "in" in self.bindings:
            value = self.read("in")
            record = (*record, None if value is MISSING else value)
        events.append(record)
        if letter == "X":
            raise RuntimeError("scripted exception")
        if letter == "S" and "out" in self.bindings:
            value = self.read("val")
            self.write("out", "done" if value is MISSING else value)
        return LETTERS[letter]

    def note_halt(self) -> None:
        if self.state is RUNNING:
            events.append((self, "halt"))


class ScriptedAction(Scripted, StatefulAction):
    def on_start(self) -> Status:
        return self.execute("start")

    def on_running(self) -> Status:
        return self.execute("run")

    def on_halted(self) -> None:
        self.note_halt()


class ScriptedSync(Scripted, SyncAction):
    def tick(self) -> Status:
        return self.execute("tick")


class ScriptedCondition(Scripted, Condition):
    def tick(self) -> Status:
        return self.execute("tick")


class ScriptedPlain(Scripted, PlainAction):
    def tick(self) -> Status:
        return self.execute("tick")

    def halt(self) -> None:
        self.note_halt()


class ScriptedCoro(Scripted, CoroAction):
    def run(self) -> Generator[None, None, Status]:
        status = self.execute("start")
        while status is RUNNING:
            yield
            status = self.execute("run")
        return status

    def halt(self) -> None:
        self.note_halt()
        super().halt()


class Setter(SyncAction):
    def tick(self) -> Status:
        value = self.read("val")
        if value is MISSING:
            events.append((self, "tick", "F"))
            return FAILURE
        events.append((self, "tick", "S"))
        self.write("out", value)
        return SUCCESS


class SetInt(Setter):
    val: In[int]
    out: Out[int]


class SetDouble(Setter):
    val: In[float]
    out: Out[float]


class SetBool(Setter):
    val: In[bool]
    out: Out[bool]


def scripted_registry() -> Registry:
    return registry().extended(
        ScriptedAction, ScriptedSync, ScriptedCondition, ScriptedPlain, ScriptedCoro, SetInt, SetDouble, SetBool
    )
