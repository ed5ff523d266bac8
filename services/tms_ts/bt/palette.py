"""The palette that Groot loads: every custom node with its ports, written from the classes.

Each is marked with the versions of the C++ system that have it, unless neither has; a task may use nodes of both.
"""

from __future__ import annotations

from lxml import etree

from tms_ts.bt.convert import CPP_NAMES, MISSING
from tms_ts.bt.node import Node
from tms_ts.bt.ports import Direction, Port
from tms_ts.bt.registry import Registry
from tms_ts.bt.registry import registry as all_nodes

MARKS = {(5,): " (version 5)", (6,): " (version 6)", (5, 6): " (versions 5 and 6)"}  # by Node.versions
PORT_TAGS = {Direction.INPUT: "input_port", Direction.OUTPUT: "output_port", Direction.INOUT: "inout_port"}


def palette(registry: Registry | None = None) -> str:
    """A document with a TreeNodesModel and nothing else; built-in nodes are left out, Groot knows them."""
    root = etree.Element("root")
    model = etree.SubElement(root, "TreeNodesModel")
    for name, cls in sorted((registry or all_nodes()).items()):
        if not cls.builtin:
            _entry(model, name, cls)
    etree.indent(root, "    ")
    return etree.tostring(root, encoding="unicode") + "\n"


def summary(cls: type[Node]) -> str:
    """The first paragraph of a node's docstring."""
    return " ".join((cls.__doc__ or "").strip().split("\n\n")[0].split())


def _entry(model: etree._Element, name: str, cls: type[Node]) -> None:
    mark = MARKS.get(cls.versions, "")
    model.append(etree.Comment(f" {name}{mark}: {summary(cls)} ".replace("--", "-")))
    entry = etree.SubElement(model, cls.kind.name.capitalize(), {"ID": name})
    for port in cls.ports.values():
        if port.name not in cls.older_ports:
            _port(entry, port, mark if len(cls.versions) == 1 else "")


def _port(entry: etree._Element, port: Port, mark: str) -> None:
    element = etree.SubElement(entry, PORT_TAGS[port.direction], {"name": port.name})
    if port.kind in CPP_NAMES and CPP_NAMES[port.kind] != "void":
        element.set("type", CPP_NAMES[port.kind])
    if port.default is not MISSING:
        element.set("default", _text(port.default))
    element.text = f"{port.help}{mark}" or None  # Groot shows this, but no comments


def _text(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    return value.name if hasattr(value, "name") else str(value)
