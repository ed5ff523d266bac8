"""Groot 1's wire: the tree as a flatbuffer, and messages about changes. Little endian throughout.

The viewer looks up every uid and every registration name that it receives, and crashes on absent strings and vectors.
So all of them are sent, empty ones too.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Mapping, Sequence

import flatbuffers

from tms_ts.bt.node import Node
from tms_ts.bt.ports import Port
from tms_ts.bt.status import Status
from tms_ts.bt.tree import Tree
from tms_ts.groot.shape import NodeModel, assignments, is_input, is_output, models, type_name

Transition = tuple[float, int, int, int]  # s since 1970, uid, old status, new status
ENTRY = struct.Struct("<HB")
TRANSITION = struct.Struct("<IIHBB")


def message(states: Mapping[int, int], changes: Sequence[Transition]) -> bytes:
    """States by uid as they were at the last message, then every change since, in order."""
    parts = [struct.pack("<I", len(states) * ENTRY.size)]
    parts += [ENTRY.pack(uid, state) for uid, state in states.items()]
    parts.append(struct.pack("<I", len(changes)))
    for stamp, uid, old, new in changes:
        microseconds = round(stamp * 1e6)
        parts.append(TRANSITION.pack(microseconds // 1_000_000, microseconds % 1_000_000, uid, old, new))
    return b"".join(parts)


def tree_reply(tree: Tree, states: Mapping[int, int]) -> bytes:
    """The flatbuffer `BehaviorTree` with present statuses."""
    return _Writer().tree(tree, states)


class _Writer:
    """Tables of the schema; field numbers count from 0 in each."""

    def __init__(self) -> None:
        self._out = flatbuffers.Builder(4096)
        self._texts: dict[str, int] = {}

    def tree(self, tree: Tree, states: Mapping[int, int]) -> bytes:
        out = self._out
        nodes = self._vector([self._node(node, states.get(node.uid, Status.IDLE)) for node in tree.nodes])
        types = self._vector([self._model(model) for model in models(tree)])
        out.StartObject(3)
        out.PrependUint16Slot(0, tree.root.uid, 0)
        out.PrependUOffsetTRelativeSlot(1, nodes, 0)
        out.PrependUOffsetTRelativeSlot(2, types, 0)
        out.Finish(out.EndObject())
        return bytes(out.Output())

    def _text(self, text: str) -> int:
        if text not in self._texts:
            self._texts[text] = self._out.CreateString(text)
        return self._texts[text]

    def _vector(self, offsets: Sequence[int]) -> int:
        self._out.StartVector(4, len(offsets), 4)
        for offset in reversed(offsets):
            self._out.PrependUOffsetTRelative(offset)
        return int(self._out.EndVector())

    def _uids(self, nodes: Sequence[Node]) -> int:
        self._out.StartVector(2, len(nodes), 2)
        for node in reversed(nodes):
            self._out.PrependUint16(node.uid)
        return int(self._out.EndVector())

    def _node(self, node: Node, state: int) -> int:
        out = self._out
        given = list(assignments(node))
        rows = [(port.name, text) for port, text in given if is_input(port)]
        rows += [(port.name, text) for port, text in given if is_output(port)]
        remaps = self._vector([self._pair(name, text) for name, text in rows])
        children = self._uids(node.children)
        name, kind = self._text(node.name), self._text(node.registration_name)
        out.StartObject(6)
        out.PrependUint16Slot(0, node.uid, 0)
        out.PrependUOffsetTRelativeSlot(1, children, 0)
        out.PrependInt8Slot(2, int(state), 0)
        out.PrependUOffsetTRelativeSlot(3, name, 0)
        out.PrependUOffsetTRelativeSlot(4, kind, 0)
        out.PrependUOffsetTRelativeSlot(5, remaps, 0)
        return int(out.EndObject())

    def _pair(self, name: str, text: str) -> int:
        left, right = self._text(name), self._text(text)
        self._out.StartObject(2)
        self._out.PrependUOffsetTRelativeSlot(0, left, 0)
        self._out.PrependUOffsetTRelativeSlot(1, right, 0)
        return int(self._out.EndObject())

    def _model(self, model: NodeModel) -> int:
        out = self._out
        ports = self._vector([self._port(port) for port in model.ports])
        name = self._text(model.name)
        out.StartObject(3)
        out.PrependUOffsetTRelativeSlot(0, name, 0)
        out.PrependInt8Slot(1, int(model.kind), 0)
        out.PrependUOffsetTRelativeSlot(2, ports, 0)
        return int(out.EndObject())

    def _port(self, port: Port) -> int:
        out = self._out
        texts: Iterable[int] = [self._text(text) for text in (port.name, type_name(port), port.help)]
        name, kind, help_text = texts
        out.StartObject(4)
        out.PrependUOffsetTRelativeSlot(0, name, 0)
        out.PrependInt8Slot(1, int(port.direction), 0)
        out.PrependUOffsetTRelativeSlot(2, kind, 0)
        out.PrependUOffsetTRelativeSlot(3, help_text, 0)
        return int(out.EndObject())
