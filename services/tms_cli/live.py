"""Shows the progress of a run: as a live tree on a terminal, as one line per change on a pipe."""

import math
import re
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import datetime, timezone
from types import TracebackType
from typing import TYPE_CHECKING, Protocol

import click

from tms_cli import words
from tms_cli.words import padded, say, state
from tms_config.clock import monotonic

if TYPE_CHECKING:
    from builtin_interfaces.msg import Time
    from tms_msg_rc.msg import MachineState
    from tms_msg_ts.action import ExecuteTask
    from tms_msg_ts.msg import NodeStatus

    from tms_cli.loads import Loads

IDLE, RUNNING, SUCCESS, FAILURE = 0, 1, 2, 3  # tms_msg_ts/NodeStatus
WORDS = {IDLE: "idle", RUNNING: "running", SUCCESS: "success", FAILURE: "failure"}
MARKS = {IDLE: "·", RUNNING: "▶", SUCCESS: "✔", FAILURE: "✘"}
COLOURS = {IDLE: "bright_black", RUNNING: "dark_orange", SUCCESS: "green", FAILURE: "red"}  # as in Groot
OUTCOME_COLOURS = {"success": "green", "running": "yellow", "preparing": "yellow", "stopping": "yellow"}
DIGITS = re.compile(r"[0-9]+")
ALL_SUCCEED = frozenset({"Sequence", "SequenceStar", "Repeat", "SubTree", "SubTreePlus"})  # as all children do
MAX_ROWS = 40  # rows of a tree on the screen; of a longer one the running part is shown


@dataclass
class NodeView:
    """One node of the tree with its last received state."""

    uid: int
    parent: int
    name: str
    type: str
    status: int = IDLE
    reason: str = ""
    goal: str = ""  # goal of a leaf, as far as it is in the task's text
    result: int = IDLE  # how it ended last: a control node sets its children back to idle when it ends

    def take(self, status: int, reason: str) -> None:
        """Take a new state; the reason stays when the state only goes back to idle."""
        self.status, self.reason = status, reason
        if status != IDLE:
            self.result = status if status in (SUCCESS, FAILURE) else IDLE

    @property
    def title(self) -> str:
        label = self.name or self.type
        if self.type and self.type != label:
            label = f"{label} ({self.type})"
        return f"{label}  {self.goal}" if self.goal else label


@dataclass
class View:
    """The state of one run from the feedback of ExecuteTask."""

    task_id: int
    description: str = ""
    goals: Sequence[tuple[str, str]] = ()  # (node type, goal) of all nodes in document order
    clock: Callable[[], float] = monotonic
    run_id: str = ""
    state: str = "preparing"
    leaf: str = ""
    reason: str = ""
    nodes: dict[int, NodeView] = field(default_factory=dict)
    machines: dict[str, "MachineState"] = field(default_factory=dict)  # by name
    loads: "Loads | None" = None
    over: bool = False
    begun: float = 0.0

    def __post_init__(self) -> None:
        self.begun = self.clock()

    @property
    def elapsed(self) -> float:
        return self.clock() - self.begun

    def received(self, feedback: "ExecuteTask.Feedback") -> list[NodeView]:
        """Take a feedback; returns the changes of nodes in order."""
        self.run_id, self.state = feedback.run_id or self.run_id, feedback.state or self.state
        self.leaf, self.reason = feedback.running_leaf, words.reason(feedback.reason)
        if not self.nodes:
            self._first(feedback.nodes)
        changed = []
        for status in feedback.nodes:
            node = self.nodes.setdefault(status.uid, NodeView(status.uid, status.parent, status.name, status.type))
            before = node.status
            node.take(status.status, words.reason(status.reason))
            if node.status != before:
                changed.append(replace(node))
        return changed

    def close(self, outcome: str) -> list[NodeView]:
        """End the view. Returns nodes that went idle before their success was received, where that is certain."""
        self.state, self.leaf, self.reason, self.over = outcome, "", "", True
        found, sure = [], {0}  # parents whose success means that their children succeeded
        for _, node in self.rows() if outcome == "success" else ():
            if node.parent in sure or node.parent not in self.nodes:
                if node.type in ALL_SUCCEED:
                    sure.add(node.uid)
                if node.result == IDLE:
                    node.result = SUCCESS
                    found.append(replace(node, status=SUCCESS))
        return found[::-1]  # children end before their parents

    def _first(self, statuses: Sequence["NodeStatus"]) -> None:
        """Take the first message, which has the whole tree; if it equals the task's text, leaves get their goals."""
        same = [status.type for status in statuses] == [kind for kind, _ in self.goals]
        goals = [goal for _, goal in self.goals] if same else [""] * len(statuses)
        for status, goal in zip(statuses, goals, strict=True):
            self.nodes[status.uid] = NodeView(status.uid, status.parent, status.name, status.type, goal=goal)

    def machine_received(self, state: "MachineState") -> None:
        """Take a tms_msg_rc/MachineState; called on ROS's thread."""
        self.machines[state.machine] = state

    def rows(self) -> Iterator[tuple[int, NodeView]]:
        """Nodes with their depth, parents before children, in the order in which they came."""
        children: dict[int, list[NodeView]] = {}
        for node in self.nodes.values():
            children.setdefault(node.parent if node.parent in self.nodes else 0, []).append(node)
        waiting = [(0, node) for node in reversed(children.get(0, []))]
        while waiting:
            depth, node = waiting.pop()
            yield depth, node
            waiting += [(depth + 1, child) for child in reversed(children.get(node.uid, []))]


def tree_rows(view: View, most: int = MAX_ROWS) -> list[tuple[int, str]]:
    """The tree as (status, line); a tree longer than `most` is cut around the first running leaf."""
    rows = list(view.rows())
    if len(rows) > most:
        active = max((i for i, (_, node) in enumerate(rows) if node.status == RUNNING), default=0)
        start = min(max(0, active - most // 2), len(rows) - most)
        rows = rows[start : start + most]
    return [(_colour(view, node), f"{'  ' * depth}{_mark(node)} {node.title}{_why(node)}") for depth, node in rows]


def _colour(view: View, node: NodeView) -> int:
    """The colour as in Groot while the run goes on; after its end, when all nodes are idle, the result of the node."""
    return node.result if view.over else node.status


def _mark(node: NodeView) -> str:
    return MARKS[node.status or node.result]


def _why(node: NodeView) -> str:
    return f"  — {node.reason}" if node.reason and node.status in (RUNNING, FAILURE) else ""


def joint_lines(machines: Mapping[str, "MachineState"]) -> list[str]:
    """Joint angles of machines, in rad and degrees."""
    lines = []
    for name, machine in sorted(dict(machines).items()):
        lines.append(f"{name}: {_posture(machine)}")
        for joint, angle in zip(machine.joint_names, machine.positions, strict=False):
            lines.append(f"  {joint:<18} {angle:8.3f} rad {math.degrees(angle):8.1f}°")
    return lines


def _posture(machine: "MachineState") -> str:
    if machine.moving:
        return say("moving")
    return say("standing") if machine.ready else say("not ready: {reason}", reason=words.reason(machine.reason))


def change_line(view: View, node: NodeView) -> str:
    """One line for a pipe or a log."""
    return f"{view.elapsed:7.1f} s  {padded(state(WORDS[node.status]), 8)} {node.title}{_why(node)}"


class Display(Protocol):
    """An output for the progress of a run."""

    def __enter__(self) -> "Display": ...

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None: ...

    def show(self, view: View, changed: Sequence[NodeView]) -> None:
        """Called after every feedback and several times a second."""


class Lines:
    """One line per node that changed, and per new reason to wait."""

    def __init__(self, err: bool = False) -> None:
        self._err = err
        self._state = self._reason = ""

    def __enter__(self) -> "Lines":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        return

    def show(self, view: View, changed: Sequence[NodeView]) -> None:
        if view.run_id and view.state != self._state and not view.over:
            self._state = view.state
            line = say("run {run}: {state}{reason}", run=view.run_id, state=state(view.state), reason="")
            click.echo(f"{view.elapsed:7.1f} s  {line}", err=self._err)
        for node in changed:
            if node.status != IDLE:  # going back to idle is not shown
                click.echo(change_line(view, node), err=self._err)
        reason = DIGITS.sub("", view.reason)  # a growing percentage is not shown
        if reason and reason != self._reason and not any(node.reason == view.reason for node in changed):
            click.echo(f"{view.elapsed:7.1f} s  {'':8} {view.reason}", err=self._err)
        for line in view.loads.news() if view.loads else ():
            click.echo(f"{view.elapsed:7.1f} s  {'':8} {line}", err=self._err)
        self._reason = reason


class Screen:
    """The whole tree, drawn anew on a terminal."""

    def __init__(self) -> None:
        from rich.console import Console
        from rich.live import Live

        self._console = Console()
        self._live = Live(console=self._console, auto_refresh=False, vertical_overflow="crop")

    def __enter__(self) -> "Screen":
        self._live.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._live.stop()

    def show(self, view: View, changed: Sequence[NodeView]) -> None:
        from rich.text import Text

        joints = [*joint_lines(view.machines), *(view.loads.lines() if view.loads else ())]
        text = Text(no_wrap=True, overflow="ellipsis")
        text.append(say("task {task}", task=view.task_id) + f" {view.description}\n", style="bold")
        text.append(say("run {run}", run=view.run_id or "-") + f"  {state(view.state)}  {view.elapsed:.1f} s\n")
        for status, line in tree_rows(view, max(5, self._console.height - len(joints) - 5)):
            text.append(line + "\n", style=COLOURS[status])
        text.append((view.reason or "") + "\n", style="yellow")
        text.append("\n".join(joints), style="cyan")
        self._live.update(text, refresh=True)


def display(as_json: bool) -> Display:
    """The screen for people, lines for pipes; with --json stdout is kept free for the document."""
    if as_json:
        return Lines(err=True)
    return Screen() if sys.stdout.isatty() else Lines()


def moment(stamp: "Time") -> datetime | None:
    """A builtin_interfaces/Time as local time; None for zero, which means never."""
    if not stamp.sec and not stamp.nanosec:
        return None
    return datetime.fromtimestamp(stamp.sec + stamp.nanosec / 1e9, timezone.utc).astimezone()


def iso(stamp: "Time") -> str | None:
    """The time in ISO 8601 for programs; None for zero."""
    when = moment(stamp)
    return when.isoformat(timespec="milliseconds") if when else None


def clock_time(stamp: "Time") -> str:
    """The time of day for people."""
    when = moment(stamp)
    return when.strftime("%Y-%m-%d %H:%M:%S") if when else "-"


def duration(seconds: float) -> str:
    """A length of time in the unit that suits it."""
    for size, unit in ((86400, "d"), (3600, "h"), (60, "min")):
        if seconds >= 2 * size:
            return f"{seconds / size:.0f} {unit}"
    return f"{seconds:.1f} s"
