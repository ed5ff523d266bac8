"""The palette that Groot loads: every custom node with its ports, written from the classes."""

from __future__ import annotations

from lxml import etree

from tms_ts.bt.convert import CPP_NAMES, MISSING
from tms_ts.bt.node import Node
from tms_ts.bt.ports import Direction, Port
from tms_ts.bt.registry import Registry
from tms_ts.bt.registry import registry as all_nodes

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
    model.append(etree.Comment(f" {name}: {summary(cls)} ".replace("--", "-")))
    entry = etree.SubElement(model, cls.kind.name.capitalize(), {"ID": name})
    for port in cls.ports.values():
        _port(entry, port)


def _port(entry: etree._Element, port: Port) -> None:
    element = etree.SubElement(entry, PORT_TAGS[port.direction], {"name": port.name})
    if port.kind in CPP_NAMES and CPP_NAMES[port.kind] != "void":
        element.set("type", CPP_NAMES[port.kind])
    if port.default is not MISSING:
        element.set("default", _text(port.default))
    element.text = port.help or None


def _text(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    return value.name if hasattr(value, "name") else str(value)
