"""The registry of node classes. Importing a module of nodes only registers its classes."""

from __future__ import annotations

import importlib
import inspect
import pkgutil
from collections.abc import Iterator, Mapping
from typing import TypeVar

from tms_ts.bt.node import Node
from tms_ts.bt.ports import Direction, Port, declare_ports

NodeClass = TypeVar("NodeClass", bound=type[Node])

BUILTIN_MODULES = (
    "control", "reactive", "parallel", "branch", "decorator", "loops", "timers", "blackboard_nodes", "subtree",
)  # fmt: skip
_recorded: dict[str, type[Node]] = {}
_generic: list[type[Node]] = []


def _prepare(cls: type[Node]) -> None:
    for attribute in inspect.get_annotations(cls):
        if hasattr(Node, attribute) and attribute not in ("asking", "builtin", "kind", "needs", "ports", "required"):
            raise TypeError(f"{cls.__name__}.{attribute} would hide a field that every node has; rename it")
    cls.ports = declare_ports(cls)
    cls.builtin = cls.__module__.startswith("tms_ts.bt.")


def node(cls: NodeClass) -> NodeClass:
    """Make a class usable in trees under its own name."""
    _prepare(cls)
    if _recorded.get(cls.__name__, cls).__module__ != cls.__module__:
        raise TypeError(f"{cls.__name__} is defined in {_recorded[cls.__name__].__module__} and {cls.__module__}")
    _recorded[cls.__name__] = cls
    return cls


def generic(cls: NodeClass) -> NodeClass:
    """Let a class run an unknown ID whose entry in TreeNodesModel has the same ports."""
    _prepare(cls)
    _generic.append(cls)
    return cls


class Registry(Mapping[str, type[Node]]):
    """Node classes by XML ID."""

    def __init__(self, classes: Mapping[str, type[Node]], generic: tuple[type[Node], ...] = ()) -> None:
        self._classes = dict(classes)
        self._generic = generic

    def __getitem__(self, name: str) -> type[Node]:
        return self._classes[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._classes)

    def __len__(self) -> int:
        return len(self._classes)

    def extended(self, *classes: type[Node]) -> Registry:
        """A copy with further classes; this registry stays as it is."""
        for cls in classes:
            _prepare(cls)
        return Registry({**self._classes, **{cls.__name__: cls for cls in classes}}, self._generic)

    def generic_for(self, name: str, ports: frozenset[str]) -> type[Node] | None:
        """A class for an ID that only the document's TreeNodesModel has, if its ports fit a generic class."""
        for base in self._generic:
            if set(base.ports) <= ports:
                cls: type[Node] = type(name, (base,), {"__slots__": (), "__doc__": base.__doc__})
                more = {port: Port(port, Direction.INPUT, str) for port in ports - set(base.ports)}
                cls.ports = {**base.ports, **more}
                return cls
        return None


def registry() -> Registry:
    """All node classes: the built-in ones, and those of the files in tms_ts/nodes."""
    for name in BUILTIN_MODULES:
        importlib.import_module(f"tms_ts.bt.{name}")
    package = importlib.import_module("tms_ts.nodes")
    for module in pkgutil.iter_modules(package.__path__):
        importlib.import_module(f"tms_ts.nodes.{module.name}")
    return Registry(_recorded, tuple(_generic))
