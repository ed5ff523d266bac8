"""The palette that Groot loads: every custom node with its ports, written from the classes.

Each is marked with the versions of the C++ system that have it, unless neither has; a task may use nodes of both.
"""

from __future__ import annotations

from dataclasses import dataclass

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
MARKS = {(5,): " (version 5)", (6,): " (version 6)", (5, 6): " (versions 5 and 6)"}  # by Node.versions
PORT_TAGS = {Direction.INPUT: "input_port", Direction.OUTPUT: "output_port", Direction.INOUT: "inout_port"}


@dataclass(frozen=True)
class Drawn:
    """What Groot draws."""

    kind: str
    text: str
    ports: tuple[Port, ...]
    versions: tuple[int, ...]  # of the C++ system that have it


def palette(registry: Registry | None = None, *, builtin: bool = False) -> str:
    """A document with a TreeNodesModel and nothing else.

    Built-in nodes, which Groot knows, are left out, or marked with an attribute of their own. The call of a template,
    which is no node of a tree that runs, is drawn like one.
    """
    root = etree.Element("root")
    model = etree.SubElement(root, "TreeNodesModel")
    known = registry or all_nodes()
    nodes = {name: _drawn(cls) for name, cls in known.items() if builtin or not cls.builtin}
    for name, drawn in sorted({**nodes, CALL: Drawn("ACTION", CALL_TEXT, CALL_PORTS, (6,))}.items()):
        entry = _entry(model, name, drawn)
        if name in known and known[name].builtin:
            entry.set("builtin", "true")
    etree.indent(root, "    ")
    return etree.tostring(root, encoding="unicode") + "\n"


def _drawn(cls: type[Node]) -> Drawn:
    ports = tuple(port for port in cls.ports.values() if port.name not in cls.older_ports)
    return Drawn(cls.kind.name, summary(cls), ports, cls.versions)


def summary(cls: type[Node]) -> str:
    """The first paragraph of a node's docstring."""
    return " ".join((cls.__doc__ or "").strip().split("\n\n")[0].split())


def _entry(model: etree._Element, name: str, drawn: Drawn) -> etree._Element:
    mark = MARKS.get(drawn.versions, "")
    model.append(etree.Comment(f" {name}{mark}: {drawn.text} ".replace("--", "-")))
    entry = etree.SubElement(model, drawn.kind.capitalize(), {"ID": name})
    for port in drawn.ports:
        _port(entry, port, mark if len(drawn.versions) == 1 else "")
    return entry


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
