"""A run's checkpoint as it is read after a crash or a power cut; damaged lines are counted. Pure logic."""

import json
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tms_decision.leaf.events import Key
from tms_decision.past import LostRun


@dataclass(frozen=True)
class Header:
    """The facts of the run that are known before its first tick."""

    run_id: str
    number: int  # fencing number
    task_id: int
    description: str
    machines: list[str]
    xml: str
    started: tuple[int, int]  # s, ns
    records: list[str] = field(default_factory=list)  # that the tree names; none in checkpoints of earlier versions
    values: dict[str, Any] = field(default_factory=dict)  # more fields of the run that are known by then
    templates: dict[str, str] = field(default_factory=dict)  # name -> text of those that the tree was made with


@dataclass(frozen=True)
class Over:
    """How a run ended whose checkpoint still exists, since the power went before it was removed."""

    outcome: str
    reason: str
    event: int  # number of the event that reports the end


class InterruptedRun:
    """A checkpoint. Without a header it cannot be used."""

    def __init__(self, lines: Iterable[dict[str, Any]]) -> None:
        self.header: Header | None = None
        self.last_event = 0
        self.last_time = 0.0  # s since 1970
        self.closed = False  # the history has it as interrupted
        self.over: Over | None = None
        self.ended: list[tuple[Key, bool]] = []
        self.open: list[Key] = []  # goals that were sent and have not ended
        self.sent_at: dict[str, float] = {}  # machine -> s since 1970 of its last goal
        self.damaged = 0  # unreadable lines, without the last one, which any crash may cut short
        for line in lines:
            try:
                self._take(line)
            except (KeyError, TypeError, ValueError, AttributeError):
                self.damaged += 1

    def lost(self, header: Header) -> LostRun:
        """What counts to close it."""
        return LostRun(header.run_id, header.number, header.machines, self.last_time, self.sent_at)

    def _take(self, line: dict[str, Any]) -> None:
        self.last_time = float(line.get("t", self.last_time))
        if "run" in line:
            self.header = Header(**{**line["run"], "started": tuple(line["run"]["started"])})
            self.closed, self.over = False, None
        elif "n" in line:
            self.last_event = max(self.last_event, int(line["n"]))
        elif "sent" in line:
            key = _key(line["sent"])
            self.open += [key] if key not in self.open else []
            self.sent_at[key[1]] = self.last_time
        elif "done" in line:
            key = _key(line["done"])
            self.ended.append((key, bool(line["ok"])))
            if key in self.open:
                self.open.remove(key)
        elif "gone" in line:
            self._forget(_key(line["gone"]), int(line["left"]))
        elif "over" in line:
            self.over = Over(str(line["over"]), str(line["reason"]), self.last_event + 1)
        self.closed = self.closed or "interrupted" in line

    def _forget(self, key: Key, left: int) -> None:
        places = [place for place, (ended, _) in enumerate(self.ended) if ended == key]
        for place in places[::-1][:left]:
            del self.ended[place]


def read(path: Path) -> InterruptedRun:
    """The checkpoint in a file; without a file, its run has just ended in order.

    Raises:
        OSError: the file cannot be read.
    """
    texts, lines, damaged = path.read_bytes().split(b"\n") if path.exists() else [], list[dict[str, Any]](), 0
    for place, text in enumerate(texts, 1):
        try:
            lines.append(json.loads(text) if text else {})
        except ValueError:
            damaged += place < len(texts)
    past = InterruptedRun(lines)
    past.damaged += damaged
    return past


def _key(words: list[str]) -> Key:
    node, machine, subtask, record = words
    return node, machine, subtask, record
