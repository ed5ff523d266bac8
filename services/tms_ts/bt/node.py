"""The base of every node. A tree is ticked by plain recursion: a parent calls `execute_tick` of its child.

Nodes are not behaviours of py_trees: its tick makes a generator per node and visit, is some fifty times slower than
the C library, and resets finished nodes by other rules. py_trees is used at the borders: its behaviours can be leaves
(py_trees_leaf.py), and its displays and visitors work on every tree (display.py).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

from tms_reason.reason import Reason
from tms_ts.bt.blackboard import Blackboard
from tms_ts.bt.context import Context
from tms_ts.bt.convert import FROM_TEXT, MISSING, convert
from tms_ts.bt.errors import TickError, within
from tms_ts.bt.ports import Direction, Pointer, Port
from tms_ts.bt.status import IDLE, RUNNING, NodeType, Status
from tms_ts.tree_reasons import AddPort, DoesNotFit, KeyChangesType, KeyHasNoValue, MissingParameter, OutputNotConnected


@dataclass(slots=True)
class NodeSpec:
    """The arguments with which a node is made."""

    registration_name: str
    name: str
    context: Context[Node]
    blackboard: Blackboard
    bindings: Mapping[str, Pointer | str] = field(default_factory=dict)
    path: str = "0"  # child positions from the root, e.g. 0.1.2
    line: int = 0
    uid: int = 0
    template: str = ""  # TEMPLATE:LINE where a template of ExecuteSubtask has it; `line` is then that of the call


AtOnce = tuple[bool, bool]  # may succeed, may fail
Place = tuple[int, str]  # what identifies a key in the tree: Blackboard.place


@dataclass(frozen=True, slots=True)
class Keys:
    """What the document tells of the keys of all blackboards."""

    texts: Mapping[str, str] = field(default_factory=dict)  # that a SetBlackboard gives a key
    writers: Mapping[Place, Node] = field(default_factory=dict)  # the first node that writes a key
    kinds: Mapping[Place, tuple[Any, int]] = field(default_factory=dict)  # the first known type, and its line
    complete: bool = True  # whether every key that is written is known before the run


class Node:
    """A node of a tree; `state` is its stored status."""

    __slots__ = (
        "bindings",
        "blackboard",
        "children",
        "context",
        "line",
        "name",
        "parent",
        "path",
        "reason",
        "registration_name",
        "state",
        "template",
        "uid",
    )
    kind: ClassVar[NodeType] = NodeType.UNDEFINED
    builtin: ClassVar[bool] = False  # part of the engine; Groot knows it
    ports: ClassVar[Mapping[str, Port]] = {}
    required: ClassVar[frozenset[str]] = frozenset()  # ports without which loading fails
    needs: ClassVar[tuple[str, ...]] = ()  # ports without which the node throws
    versions: ClassVar[tuple[int, ...]] = ()  # of the C++ system that have this node
    older_ports: ClassVar[frozenset[str]] = frozenset()  # that older tasks have; the palette leaves them out
    asking: ClassVar[bool] = False  # RUNNING only because an answer has not come yet
    key_port: ClassVar[str] = ""  # an input that names a key which it writes
    key_kind: ClassVar[Any] = Any  # the type of what it writes there; Any: only the run decides

    def __init__(self, birth: NodeSpec) -> None:
        self.name = birth.name
        self.registration_name = birth.registration_name
        self.context = birth.context
        self.blackboard = birth.blackboard
        self.bindings = birth.bindings
        self.path = birth.path
        self.line = birth.line
        self.uid = birth.uid
        self.template = birth.template
        self.state: Status = IDLE
        self.reason: Reason | None = None  # why it is RUNNING or has failed, for the operator
        self.parent: Node | None = None
        self.children: list[Node] = []
        self.prepare()

    def endless(self) -> bool:
        """Whether it runs its child again and again, without an end that the document gives."""
        return False

    def prepare(self) -> None:
        """For node authors: set the node's own fields once, when the tree is made."""

    # --- tick and halt

    def tick(self) -> Status:
        raise NotImplementedError

    def execute_tick(self) -> Status:
        status = self.tick()
        if status is not self.state:
            self.set_state(status)
        return status

    def halt(self) -> None:
        """Called on a RUNNING node that has to stop, and on every node when the whole tree is halted."""

    def set_state(self, new: Status) -> None:
        old = self.state
        if new is not old:
            self.state = new
            for observer in self.context.observers:
                observer(self, old, new)
            if new is IDLE:
                self.reason = None

    def reset(self) -> None:
        """Called by the parent: halt the node if it is RUNNING, and make it IDLE even if its halt raises."""
        try:
            if self.state is RUNNING:
                self.halt()
        finally:
            self.set_state(IDLE)

    def only_asks(self) -> bool:
        """Whether all RUNNING leaves here only wait for an answer."""
        running = [child for child in self.children if child.state is RUNNING]
        return all(child.only_asks() for child in running) if running else self.asking

    # --- ports

    def read(self, port: str) -> Any:
        """The value of an input, or MISSING if it cannot be read."""
        bound = self.bindings.get(port)
        spec = self.ports[port]
        if bound is None:
            return spec.default
        if isinstance(bound, Pointer):
            value = self.blackboard.get(bound.key)
            return value if value is MISSING else convert(value, spec.kind)
        return FROM_TEXT[spec.kind](bound)

    def require(self, port: str) -> Any:
        value = self.read(port)
        if value is MISSING:
            raise TickError(MissingParameter(self.registration_name, port), hint=self._why_missing(port))
        return value

    def write(self, port: str, value: Any) -> None:
        """Write an output; a port that is bound to plain text uses the text as the key."""
        bound = self.bindings.get(port)
        if bound is None:
            raise TickError(OutputNotConnected(self.registration_name, port))
        key = bound.key if isinstance(bound, Pointer) else bound
        self.blackboard.set(key, value, self.ports[port].kind)

    def store(self, key: str, value: Any) -> None:
        """Write a key whose name the node has computed, also if that changes the key's type."""
        if self.blackboard.replace(key, value):
            self.warn(KeyChangesType(key))

    def literal(self, port: str) -> str | None:
        """The text of a port that does not point at the blackboard."""
        bound = self.bindings.get(port)
        if isinstance(bound, str):
            return bound
        default = self.ports[port].default
        return default if bound is None and isinstance(default, str) else None

    def assigned(self) -> dict[str, str]:
        """Port assignments as written in the document."""
        return {port: b.text if isinstance(b, Pointer) else b for port, b in self.bindings.items()}

    def _why_missing(self, port: str) -> Reason:
        bound = self.bindings.get(port)
        if bound is None:
            return AddPort(port, self.line)
        if isinstance(bound, Pointer):
            return KeyHasNoValue(bound.key)
        return DoesNotFit(bound)

    def inputs(self) -> list[Port]:
        return [port for port in self.ports.values() if port.direction is not Direction.OUTPUT]

    def warn(self, what: Reason) -> None:
        self.context.warn(self.line, within(self.template, what))

    # --- preflight

    def faults(self) -> list[Reason]:
        """Why it throws whenever it is ticked."""
        return []

    def written(self) -> list[tuple[str, Any]]:
        """Keys that it writes, as far as the document names them, with their types; Any where only the run decides."""
        found: list[tuple[str, Any]] = []
        for name, bound in self.bindings.items():
            port = self.ports[name]
            if isinstance(bound, Pointer) and port.direction is not Direction.INPUT:
                found.append((bound.key, port.kind if port.direction is Direction.OUTPUT else Any))
            elif isinstance(bound, str) and port.direction is Direction.OUTPUT:
                found.append((bound, port.kind))
        named = self.literal(self.key_port) if self.key_port else None
        return found if named is None else [*found, (named, self.key_kind)]

    def needed(self) -> list[str]:
        """Keys without whose value it fails, as far as the document names them."""
        return []

    def number_written(self, keys: Keys, key: str) -> bool:
        """Whether a node gives a key a number, as far as the document tells."""
        return keys.kinds.get(self.blackboard.place(key), (Any, 0))[0] in (int, float)

    def synchronous_outcomes(self, children: list[AtOnce]) -> AtOnce:
        """Whether it may succeed and may fail within one tick in the library, given what its children may."""
        return False, False

    def may_hang(self, children: list[AtOnce]) -> bool:
        return False

    def preflight(self, keys: Keys) -> list[Reason]:
        """What the author should know."""
        return []


Observer = Callable[[Node, Status, Status], None]
