"""A loaded tree, which can be ticked, halted and inspected."""

from __future__ import annotations

import itertools
import threading
from dataclasses import dataclass
from types import TracebackType
from typing import ClassVar, Protocol, runtime_checkable

from tms_reason.reason import Reason
from tms_ts.bt.blackboard import Blackboard
from tms_ts.bt.context import Context
from tms_ts.bt.document import Document
from tms_ts.bt.errors import TickError, TreeError
from tms_ts.bt.node import Node, Observer
from tms_ts.bt.parallel import Parallel
from tms_ts.bt.py_trees_leaf import PyTreesLeaf, Worker
from tms_ts.bt.status import IDLE, Status
from tms_ts.tree_reasons import NodeError

MAX_UID = 65_535  # 16 bit on Groot's wire
_next_uid = itertools.count()
_uid_lock = threading.Lock()


@dataclass(frozen=True, slots=True)
class LeafGoal:
    """The goal that a leaf will send; a part that is known only during the run is its {key}."""

    machine: str
    subtask: str
    record: str
    path: str
    line: int
    template: str = ""  # TEMPLATE:LINE, empty for a leaf of the task itself


@runtime_checkable
class SendsGoal(Protocol):
    """A leaf that sends a goal to a machine."""

    def goal_asked(self) -> tuple[str, str, str]: ...  # machine, subtask, record


@runtime_checkable
class UsesRecord(Protocol):
    """A leaf that reads or writes a field of a shared record."""

    writes: ClassVar[bool]

    def record_asked(self) -> tuple[str, str]: ...  # record, field; a part known only during the run is its {key}


@dataclass(frozen=True, slots=True)
class SharedValue:
    """A field of a shared record that a leaf reads or writes."""

    record: str
    field: str
    writes: bool
    path: str
    line: int
    looped: bool  # whether the leaf is repeated in an endless loop
    template: str = ""  # TEMPLATE:LINE, empty for a leaf of the task itself


class Tree:
    """A tree that is ready to be ticked."""

    def __init__(
        self,
        root: Node,
        nodes: list[Node],
        blackboards: list[Blackboard],
        context: Context[Node],
        document: Document,
    ) -> None:
        self.name = document.main  # ID of the main tree
        self.root = root
        self.nodes = nodes  # pre-order
        self.blackboards = blackboards  # in creation order, the root's first
        self.context = context
        self.templates = document.templates  # name -> text of those that it was made with
        self._parallels = {node.path for node in nodes if isinstance(node, Parallel)}
        with _uid_lock:
            for node in nodes:
                node.uid = next(_next_uid) % MAX_UID + 1

    @property
    def observers(self) -> list[Observer]:
        """Called with (node, old, new) at every change of a stored status, in order."""
        return self.context.observers

    @property
    def faults(self) -> list[TreeError]:
        """Errors of nodes that throw whenever they are ticked: the tree can be loaded, but must not run."""
        return [TreeError(what, line=line, path=path) for line, path, what in self.context.faults]

    @property
    def warnings(self) -> list[tuple[int, Reason]]:
        """Advice for the author, mostly on what runs here but hangs or throws in the library: (line, what)."""
        return self.context.warnings

    def tick(self) -> Status:
        """Tick the root once. An exception of a node leaves the statuses as they are: the caller must halt the tree."""
        self.context.begin_tick()
        try:
            self.poll()
            status = self.root.execute_tick()
        except TreeError as error:
            _place(error)
            raise
        except Exception as error:
            found = TickError(NodeError(type(error).__name__, str(error))).with_traceback(error.__traceback__)
            raise _place(found) from error
        if status.completed:
            self.root.set_state(IDLE)
        return status

    def poll(self) -> None:
        """Expire the timers that are due; a Timeout halts its child here."""
        context = self.context
        if context.timers:
            now = context.clock()
            due = [(timer.deadline, timer) for timer in context.timers if timer.deadline is not None]
            for deadline, timer in sorted(due, key=lambda item: item[0]):
                if deadline <= now and timer.deadline is not None:  # an earlier timer has not disarmed it
                    timer.expire()

    def halt(self) -> None:
        """Halt the whole tree. A node that raises does not keep the others from being halted."""
        problems: list[Exception] = []
        for node in [self.root, *self.nodes]:
            try:
                try:
                    node.halt()
                finally:
                    node.set_state(IDLE)
            except Exception as error:  # a leaf that cannot stop its machine must not keep other machines moving
                problems.append(error)
        if problems:
            first = problems[0]
            found = first if isinstance(first, TreeError) else TickError(NodeError(type(first).__name__, str(first)))
            raise _place(found.with_traceback(first.__traceback__)) from first

    def halt_root(self) -> None:
        """Do only what the library's `root.halt()` does: the root keeps its own status."""
        self.root.halt()

    def workers(self) -> list[Worker]:
        """Threads and processes of behaviours that were asked to end and have not ended."""
        return [worker for node in self.nodes if isinstance(node, PyTreesLeaf) for worker in node.workers()]

    def leaf_goals(self) -> list[LeafGoal]:
        return [
            LeafGoal(*node.goal_asked(), node.path, node.line, node.template)
            for node in self.nodes
            if isinstance(node, SendsGoal)
        ]

    def shared_values(self) -> list[SharedValue]:
        return [
            SharedValue(*node.record_asked(), node.writes, node.path, node.line, _looped(node), node.template)
            for node in self.nodes
            if isinstance(node, UsesRecord)
        ]

    def beside(self, path: str, other: str) -> bool:
        """Whether a Parallel runs two nodes in branches of their own, so that neither waits for the other."""
        pairs = zip(path.split("."), other.split("."), strict=False)
        common = itertools.takewhile(lambda pair: pair[0] == pair[1], pairs)
        return ".".join(one for one, _ in common) in self._parallels

    def running(self) -> list[Node]:
        """The leaves that are RUNNING now."""
        return [node for node in self.nodes if not node.children and node.state is Status.RUNNING]


def _looped(node: Node) -> bool:
    above = node.parent
    while above is not None and not above.endless():
        above = above.parent
    return above is not None


def _place(error: TreeError) -> TreeError:
    """Add to an error the node that raised it: the innermost node with an entry in the traceback."""
    trace: TracebackType | None = error.__traceback__
    thrower: Node | None = None
    while trace is not None:
        owner = trace.tb_frame.f_locals.get("self")
        if isinstance(owner, Node):
            thrower = owner
        trace = trace.tb_next
    if thrower is not None and not error.path:
        error.place(thrower.line, thrower.path, thrower.template)
    return error
