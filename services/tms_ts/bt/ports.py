"""Ports: declared as annotated fields of a node class, bound to text or to a blackboard key by the document."""

from __future__ import annotations

import re
from dataclasses import dataclass
from enum import IntEnum
from typing import Annotated, Any, Protocol, TypeAlias, TypeVar, get_args, get_origin, get_type_hints

from tms_ts.bt.convert import CPP_NAMES, MISSING

T = TypeVar("T")


class Direction(IntEnum):
    """Whether a node reads a port, writes it, or both."""

    INPUT = 0
    OUTPUT = 1
    INOUT = 2


In: TypeAlias = Annotated[T, Direction.INPUT]
Out: TypeAlias = Annotated[T, Direction.OUTPUT]
InOut: TypeAlias = Annotated[T, Direction.INOUT]

RESERVED = frozenset({"ID", "name", "_description"})


@dataclass(frozen=True, slots=True)
class Port:
    """A port as a class of nodes declares it."""

    name: str
    direction: Direction
    kind: Any  # a Python type, or Any for an untyped port
    default: Any = MISSING
    help: str = ""


@dataclass(frozen=True, slots=True)
class Pointer:
    """A port that is bound to a blackboard key."""

    key: str
    text: str  # as written


def bind(port: str, text: str, *, v4: bool = False) -> Pointer | str:
    """What an attribute's text means: a pointer `{key}` or `${key}`, `=` for the port's own name, or the text."""
    if text == "=" or (v4 and text == "{=}"):
        return Pointer(port, text)
    if len(text) >= 3 and text[0] == "{" and text[-1] == "}":
        return Pointer(text[1:-1], text)
    if len(text) >= 4 and text.startswith("${") and text[-1] == "}":
        return Pointer(text[2:-1], text)
    return text


class HasPorts(Protocol):
    """A node, as far as its ports go."""

    def require(self, port: str) -> Any: ...
    def write(self, port: str, value: Any) -> None: ...


class PortAccess:
    """Makes a port read and write like a plain field inside a node."""

    __slots__ = ("port",)

    def __init__(self, port: Port) -> None:
        self.port = port

    def __get__(self, node: HasPorts | None, owner: type) -> Any:
        return self if node is None else node.require(self.port.name)

    def __set__(self, node: HasPorts, value: Any) -> None:
        node.write(self.port.name, value)


def _port_help(cls: type) -> dict[str, str]:
    """Lines `port: text` of the docstring, and of those of its bases, describe the ports."""
    texts = "\n".join(base.__doc__ or "" for base in reversed(cls.__mro__))
    return dict(re.findall(r"^\s*(\w+): (.+)$", texts, re.MULTILINE))


def declare_ports(cls: type) -> dict[str, Port]:
    """Read the annotations of a node class and put accessors in their place."""
    ports: dict[str, Port] = {}
    texts = _port_help(cls)
    for attribute, hint in get_type_hints(cls, include_extras=True).items():
        if get_origin(hint) is not Annotated or not isinstance(get_args(hint)[1], Direction):
            continue
        kind, direction = get_args(hint)[:2]
        name = attribute.rstrip("_")
        if name in RESERVED or kind not in CPP_NAMES:
            raise TypeError(f"{cls.__name__}.{attribute}: not a possible port")
        given = getattr(cls, attribute, MISSING)
        inherited = given.port if isinstance(given, PortAccess) else None
        ports[name] = Port(name, direction, kind, inherited.default if inherited else given, texts.get(name, ""))
        setattr(cls, attribute, PortAccess(ports[name]))
    return ports
