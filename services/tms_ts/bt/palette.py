"""The palette that Groot loads: every custom node with its ports, written from the classes."""

from __future__ import annotations

from collections.abc import Iterable

from lxml import etree

from tms_reason.xml_text import CALL
from tms_ts.bt.convert import CPP_NAMES, MISSING
from tms_ts.bt.node import Node
from tms_ts.bt.ports import Direction, Port
from tms_ts.bt.registry import Registry
from tms_ts.bt.registry import registry as all_nodes

CALL_TEXT = "The tree of a template comes in this place."
CALL_PORTS = tuple(
    Port(name, Direction.INPUT, str, help=text)
    for name, text in {
        "machine_record_name": "value of $machine_record_name$ in the template",
        "model_name": "value of $model_name$ in the template",
        "subtask_name": "name of the template",
        "subtask_parameters": "values of further keys of the template, as key:value,key:value",
        "terminate_condition": "value of $terminate_condition$ in the template",
    }.items()
)
PORT_TAGS = {Direction.INPUT: "input_port", Direction.OUTPUT: "output_port", Direction.INOUT: "inout_port"}


def palette(registry: Registry | None = None) -> str:
    """A document with a TreeNodesModel and nothing else; built-in nodes are left out, Groot knows them.

    The call of a template, which is no node of a tree that runs, is drawn like one.
    """
    root = etree.Element("root")
    model = etree.SubElement(root, "TreeNodesModel")
    nodes = {
        name: (cls.kind.name, summary(cls), tuple(cls.ports.values()))
        for name, cls in (registry or all_nodes()).items()
        if not cls.builtin
    }
    for name, (kind, text, ports) in sorted({**nodes, CALL: ("ACTION", CALL_TEXT, CALL_PORTS)}.items()):
        _entry(model, name, kind, text, ports)
    etree.indent(root, "    ")
    return etree.tostring(root, encoding="unicode") + "\n"


def summary(cls: type[Node]) -> str:
    """The first paragraph of a node's docstring."""
    return " ".join((cls.__doc__ or "").strip().split("\n\n")[0].split())


def _entry(model: etree._Element, name: str, kind: str, text: str, ports: Iterable[Port]) -> None:
    model.append(etree.Comment(f" {name}: {text} ".replace("--", "-")))
    entry = etree.SubElement(model, kind.capitalize(), {"ID": name})
    for port in ports:
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
