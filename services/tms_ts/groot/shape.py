"""A tree and its node types in the form that both versions of Groot need."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from tms_ts.bt.convert import CPP_NAMES, MISSING
from tms_ts.bt.node import Node
from tms_ts.bt.ports import Direction, Pointer, Port
from tms_ts.bt.registry import registry
from tms_ts.bt.status import NodeType
from tms_ts.bt.tree import Tree


@dataclass(frozen=True, slots=True)
class NodeModel:
    """A node type."""

    name: str
    kind: NodeType
    ports: tuple[Port, ...]


def models(tree: Tree) -> list[NodeModel]:
    """All known types, and those that only this tree's document describes."""
    found = {name: NodeModel(name, cls.kind, tuple(cls.ports.values())) for name, cls in registry().items()}
    for node in tree.nodes:
        name = node.registration_name
        found.setdefault(name, NodeModel(name, node.kind, tuple(node.ports.values())))
    return list(found.values())


def type_name(port: Port) -> str:
    """The C++ name of a port's type."""
    return CPP_NAMES.get(port.kind, "void")


def assignments(node: Node) -> Iterator[tuple[Port, str]]:
    """Ports of a node with their text as written, defaults filled in."""
    for port in node.ports.values():
        bound = node.bindings.get(port.name)
        if bound is not None:
            yield port, bound.text if isinstance(bound, Pointer) else bound
        elif port.default is not MISSING:
            yield port, default_text(port.default)


def default_text(value: object) -> str:
    """A default value as Groot shows it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    return value.name if hasattr(value, "name") else str(value)


def is_input(port: Port) -> bool:
    """Whether a node reads the port."""
    return port.direction is not Direction.OUTPUT


def is_output(port: Port) -> bool:
    """Whether a node writes the port."""
    return port.direction is not Direction.INPUT
