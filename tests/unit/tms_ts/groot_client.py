"""What Groot reads, read by generic means: flatbuffer tables by field number, messages by their layout."""

import struct
from typing import Any

import flatbuffers
from flatbuffers import number_types as types
from flatbuffers.table import Table

Tree = dict[str, Any]


def tree(data: bytes) -> Tree:
    """The tree reply; asserts everything whose absence would crash the viewer."""
    root = Table(bytearray(data), struct.unpack_from("<I", data)[0])
    nodes = [_node(table) for table in _tables(root, 1)]
    return {"root_uid": _number(root, 0, types.Uint16Flags), "nodes": nodes,
            "node_models": [_model(table) for table in _tables(root, 2)]}  # fmt: skip


def message(data: bytes) -> tuple[dict[int, int], list[tuple[float, int, int, int]]]:
    """(states before, changes) of one published message."""
    (length,) = struct.unpack_from("<I", data)
    states = dict(struct.iter_unpack("<HB", data[4 : 4 + length]))
    (count,) = struct.unpack_from("<I", data, 4 + length)
    rest = data[8 + length :]
    assert len(rest) == 12 * count
    changes = [(sec + usec * 1e-6, uid, old, new) for sec, usec, uid, old, new in struct.iter_unpack("<IIHBB", rest)]
    return states, changes


def _node(table: Table) -> Tree:
    children = _vector(table, 1)
    return {
        "uid": _number(table, 0, types.Uint16Flags),
        "children_uid": [table.Get(types.Uint16Flags, children + 2 * i) for i in range(_length(table, 1))],
        "status": _number(table, 2, types.Int8Flags),
        "instance_name": _text(table, 3),
        "registration_name": _text(table, 4),
        "port_remaps": [[_text(pair, 0), _text(pair, 1)] for pair in _tables(table, 5)],
    }


def _model(table: Table) -> Tree:
    ports = [{"port_name": _text(port, 0), "direction": _number(port, 1, types.Int8Flags),
              "type_info": _text(port, 2), "description": _text(port, 3)} for port in _tables(table, 2)]  # fmt: skip
    return {"registration_name": _text(table, 0), "type": _number(table, 1, types.Int8Flags), "ports": ports}


def _place(table: Table, field: int) -> int:
    return int(table.Offset(4 + 2 * field))


def _number(table: Table, field: int, kind: Any) -> int:
    place = _place(table, field)
    return int(table.Get(kind, table.Pos + place)) if place else 0


def _text(table: Table, field: int) -> str:
    place = _place(table, field)
    assert place, f"text {field} is absent: the viewer would crash"
    return str(table.String(table.Pos + place).decode())


def _vector(table: Table, field: int) -> int:
    place = _place(table, field)
    assert place, f"vector {field} is absent: the viewer would crash"
    return int(table.Vector(place))


def _length(table: Table, field: int) -> int:
    return int(table.VectorLen(_place(table, field)))


def _tables(table: Table, field: int) -> list[Table]:
    start = _vector(table, field)
    return [Table(table.Bytes, table.Indirect(start + 4 * i)) for i in range(_length(table, field))]


assert flatbuffers
