"""Preflight: what the author should know before a run, found without running anything.

Most of it concerns trees that run here, but hang or throw in the C++ system.
"""

from __future__ import annotations

from typing import Any

from tms_reason.reason import Reason
from tms_ts.bt.blackboard_nodes import SetBlackboard
from tms_ts.bt.convert import CPP_NAMES, FROM_TEXT, MISSING
from tms_ts.bt.errors import within
from tms_ts.bt.node import AtOnce, Keys, Node, Place
from tms_ts.bt.ports import Direction, Pointer
from tms_ts.tree_reasons import KeyOfTwoTypes, MayHang, NeverWritten, PortType, ThrowsWithoutPort

Written = list[tuple[Node, list[tuple[str, Any]]]]  # each node, and the keys that it writes with their types


def advise(nodes: list[Node]) -> None:
    """Add the warnings of all nodes to their tree; `nodes` is in pre-order."""
    synchronous_outcomes: dict[Node, AtOnce] = {}
    for node in reversed(nodes):  # children before their parents
        synchronous_outcomes[node] = node.synchronous_outcomes([synchronous_outcomes[child] for child in node.children])
    written = [(node, node.written()) for node in nodes]
    keys = known_keys(written)
    type_changes(written, keys)
    for node in nodes:
        for fault in node.faults():
            node.context.faults.append((node.line, node.path, within(node.template, fault)))
        for note in (*literals(node), *node.preflight(keys), *(never_written(node, keys) if keys.complete else ())):
            node.warn(note)
        if node.may_hang([synchronous_outcomes[child] for child in node.children]):
            node.warn(MayHang(node.registration_name))


def type_changes(written: Written, keys: Keys) -> None:
    """Warn of keys that nodes write with different types; a text that comes first leaves the type open."""
    for node, found in written:
        for key, kind in found:
            known, line = keys.kinds.get(node.blackboard.place(key), (kind, node.line))
            if known is not str and kind not in (known, Any):
                node.warn(KeyOfTwoTypes(key, CPP_NAMES[known], line, CPP_NAMES[kind]))


def known_keys(written: Written) -> Keys:
    """What the nodes write, in document order."""
    texts: dict[str, str] = {}
    writers: dict[Place, Node] = {}
    kinds: dict[Place, tuple[Any, int]] = {}
    for node, found in written:
        if isinstance(node, SetBlackboard):
            key, value = node.literal("output_key"), node.literal("value")
            if key is not None and value is not None:
                texts[key] = value
        for key, kind in found:
            place = node.blackboard.place(key)
            writers.setdefault(place, node)
            if kind is not Any:
                kinds.setdefault(place, (kind, node.line))
    complete = not any(isinstance(node.bindings.get(node.key_port), Pointer) for node, _ in written)
    return Keys(texts, writers, kinds, complete)


def never_written(node: Node, keys: Keys) -> list[Reason]:
    """Warnings of keys that a node needs and that nothing in the document gives a value."""
    needed = node.needed()
    if not needed:  # most nodes
        return []
    missing = [key for key in needed if node.blackboard.place(key) not in keys.writers]
    return [NeverWritten(key, node.registration_name) for key in missing if node.blackboard.get(key) is MISSING]


def literals(node: Node) -> list[Reason]:
    """Port texts that do not fit the port's type, and missing ports without which the node throws."""
    notes: list[Reason] = []
    for port in node.needs:
        if port not in node.bindings and node.ports[port].default is MISSING:
            notes.append(ThrowsWithoutPort(node.registration_name, port))
    for port, bound in node.bindings.items():
        if isinstance(bound, str):
            spec = node.ports[port]
            if spec.direction is not Direction.OUTPUT and FROM_TEXT[spec.kind](bound) is MISSING:
                notes.append(PortType(port, bound, node.registration_name, CPP_NAMES[spec.kind]))
    return notes
