"""Groot 2's wire: requests are one letter, answers are the tree as v4 XML, states, or blackboards.

Breakpoints are refused: a viewer must not be able to hold a machine's tree.
"""

from __future__ import annotations

import struct
import uuid
from collections.abc import Iterator, Mapping
from typing import Any

import msgpack
from lxml import etree

from tms_ts.bt.blackboard import Blackboard
from tms_ts.bt.convert import MISSING
from tms_ts.bt.node import Node
from tms_ts.bt.palette import PORT_TAGS
from tms_ts.bt.ports import Port
from tms_ts.bt.status import IDLE, NodeType
from tms_ts.bt.tree import Tree
from tms_ts.groot.shape import assignments, default_text, models, type_name

PROTOCOL = 2
HEADER = struct.Struct("<BBI")
STATE = struct.Struct("<HB")
WAS = 10  # added to the last state of a node that has become idle
V4_NAMES = {"SequenceStar": "SequenceWithMemory", "SubTreePlus": "SubTree"}
V4_PORTS = {"success_threshold": "success_count", "failure_threshold": "failure_count"}


class Groot2:
    """Answers requests about one tree, with the states that the caller gives."""

    def __init__(self, tree: Tree) -> None:
        self._id = uuid.uuid4().bytes
        self._tree = tree
        self._paths = {path: root for path, root, _ in _instances(tree)}
        self._xml = _document(tree)

    def answer(self, frames: list[bytes], states: Mapping[int, int], before: Mapping[int, int]) -> list[bytes]:
        """Reply to a request; `before` is each node's last state that was not idle."""
        if not frames or len(frames[0]) != HEADER.size:
            return _error("a request begins with a header of 6 bytes")
        protocol, letter, number = HEADER.unpack(frames[0])
        if protocol != PROTOCOL:
            return _error(f"protocol {protocol} is not spoken here, {PROTOCOL} is")
        head = HEADER.pack(PROTOCOL, letter, number) + self._id
        if letter == ord("T"):
            return [head, self._xml]
        if letter == ord("S"):
            return [head, b"".join(STATE.pack(uid, _shown(state, before.get(uid, 0))) for uid, state in states.items())]
        if letter == ord("B"):
            return [head, self._blackboards(frames[1] if len(frames) > 1 else b"")]
        return _error(f"request '{chr(letter)}' is not served: this scheduler has no breakpoints and no recording")

    def _blackboards(self, names: bytes) -> bytes:
        asked = names.decode("utf-8", "replace").split(";")
        boards = {name: _values(self._paths[name].blackboard) for name in asked if name in self._paths}
        return bytes(msgpack.packb(boards))


def _error(text: str) -> list[bytes]:
    return [b"error", text.encode()]


def _shown(state: int, before: int) -> int:
    return before + WAS if state == IDLE and before else state


def _values(board: Blackboard) -> dict[str, Any]:
    return {key: value if _travels(value) else None for key, value in list(board.items())}


def _travels(value: object) -> bool:
    if isinstance(value, list):
        return all(isinstance(part, (bool, int, float, str)) for part in value)
    return isinstance(value, (bool, int, float, str)) and not (isinstance(value, int) and abs(value) >= 2**63)


def _instances(tree: Tree) -> Iterator[tuple[str, Node, str]]:
    """(name of the instance, its first node, ID of the tree), the main tree first."""
    yield tree.name, tree.root, tree.name
    paths: dict[int, str] = {}
    for node in tree.nodes:
        if node.kind is NodeType.SUBTREE:
            outer = next((paths[above.uid] for above in _above(node) if above.uid in paths), "")
            paths[node.uid] = (f"{outer}/" if outer else "") + f"{node.name}::{node.uid}"
            yield paths[node.uid], node.children[0], node.name


def _above(node: Node) -> Iterator[Node]:
    while node.parent is not None:
        node = node.parent
        yield node


def _document(tree: Tree) -> bytes:
    root = etree.Element("root", BTCPP_format="4")
    paths = {first.parent.uid: path for path, first, _ in _instances(tree) if first.parent is not None}
    for path, first, name in _instances(tree):
        top = etree.SubElement(root, "BehaviorTree", ID=name, _fullpath="" if first is tree.root else path)
        _element(top, first, paths)
    catalogue = etree.SubElement(root, "TreeNodesModel")
    for model in models(tree):
        entry = etree.SubElement(catalogue, model.kind.name.capitalize().replace("Subtree", "SubTree"))
        entry.set("ID", V4_NAMES.get(model.name, model.name))
        for port in model.ports:
            _port(entry, port)
    return bytes(etree.tostring(root))


def _element(parent: etree._Element, node: Node, paths: Mapping[int, str]) -> None:
    subtree = node.kind is NodeType.SUBTREE
    kind = node.registration_name
    element = etree.SubElement(parent, "SubTree") if subtree else _named(parent, node, V4_NAMES.get(kind, kind))
    element.set("_uid", str(node.uid))
    if subtree:
        element.set("ID", node.name)
        element.set("_fullpath", paths[node.uid])
        return
    element.set("name", node.name)
    for port, text in assignments(node):
        element.set(_v4_port(node.registration_name, port.name), text)
    for child in node.children:
        _element(element, child, paths)


def _named(parent: etree._Element, node: Node, name: str) -> etree._Element:
    try:
        return etree.SubElement(parent, name)
    except ValueError:  # an ID that cannot be a tag; documents write it as <Action ID="2nd try">
        return etree.SubElement(parent, node.kind.name.capitalize(), ID=name)


def _v4_port(kind: str, port: str) -> str:
    return V4_PORTS.get(port, port) if kind == "Parallel" else port


def _port(entry: etree._Element, port: Port) -> None:
    element = etree.SubElement(entry, PORT_TAGS[port.direction], name=_v4_port(entry.get("ID", ""), port.name))
    element.set("type", type_name(port))
    if port.default is not MISSING:
        element.set("default", default_text(port.default))
    element.text = port.help or None
