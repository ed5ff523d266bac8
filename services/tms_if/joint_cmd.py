"""The two layouts of com3_msgs/JointCmd on the wire, which only a site setting distinguishes. Pure logic.

OPERA's main branch has `uint8 control_type` after `joint_name`; OperaSim-PhysX, and OperaSim-AGX, were built without
it. A reader of the other layout gets right values as long as the length of the last name leaves room in the padding,
and otherwise takes positions for velocities. So a message for the other layout is rewritten, never passed on unchanged.
"""

import struct
from dataclasses import dataclass
from typing import Literal

Layout = Literal["control_type", "plain"]
OURS: Layout = "control_type"  # layout of the package in services/interfaces
TYPE = "com3_msgs/JointCmd"
HEADER = b"\0\1\0\0"  # CDR, little-endian
POSITION, VELOCITY, EFFORT = 0, 1, 2


class LayoutError(Exception):
    """The bytes are no JointCmd of the expected layout."""


@dataclass(frozen=True)
class JointCmd:
    """Content of a message; `control_type` is None where the layout has none."""

    names: list[bytes]
    control_type: int | None
    position: list[float]
    velocity: list[float]
    effort: list[float]

    @property
    def meant(self) -> int:
        """The kind of control: `control_type`, or where that is None, the first array that is filled in."""
        if self.control_type is not None:
            return self.control_type
        filled = [kind for kind, values in enumerate((self.position, self.velocity, self.effort)) if any(values)]
        if filled:
            return filled[0]
        given = [kind for kind, values in enumerate((self.position, self.velocity, self.effort)) if values]
        return given[0] if given else POSITION


def convert(data: bytes, into: Layout) -> bytes:
    """Rewrite a message of the other layout in the layout `into`.

    Raises:
        LayoutError: it is damaged, or already has the other layout.
    """
    return write(read(data, "plain" if into == "control_type" else "control_type"), into)


def read(data: bytes, layout: Layout) -> JointCmd:
    """Decode one layout; every byte must belong to a field, except for padding at the end.

    Raises:
        LayoutError: the bytes do not fit.
    """
    reader = _CdrReader(data)
    names = reader.strings()
    control = reader.byte() if layout == "control_type" else None
    found = JointCmd(names, control, reader.doubles(), reader.doubles(), reader.doubles())
    if reader.left > 3:
        raise LayoutError(f"{reader.left} bytes too many for a JointCmd {_words(layout)}")
    return found


def write(message: JointCmd, layout: Layout) -> bytes:
    """Encode one layout."""
    out = bytearray(struct.pack("<I", len(message.names)))
    for name in message.names:
        _pad(out, 4)
        out += struct.pack("<I", len(name) + 1) + name + b"\0"
    if layout == "control_type":
        out.append(message.meant)
    for values in (message.position, message.velocity, message.effort):
        _pad(out, 4)
        out += struct.pack("<I", len(values))
        if values:
            _pad(out, 8)
        out += struct.pack(f"<{len(values)}d", *values)
    return HEADER + bytes(out)


def _words(layout: Layout) -> str:
    return "with control_type" if layout == "control_type" else "without control_type"


def _pad(out: bytearray, size: int) -> None:
    out += bytes(-len(out) % size)


class _CdrReader:
    """CDR without its header; alignment counts from the first byte after it."""

    def __init__(self, data: bytes) -> None:
        if data[:2] != HEADER[:2]:
            raise LayoutError("no little-endian CDR header")
        self._data, self._at = data[4:], 0

    @property
    def left(self) -> int:
        return len(self._data) - self._at

    def _take(self, size: int, align: int) -> bytes:
        begin = self._at + -self._at % align
        if begin + size > len(self._data):
            raise LayoutError("it ends too early for a JointCmd: has the sender the other layout?")
        self._at = begin + size
        return self._data[begin : self._at]

    def _count(self) -> int:
        return int(struct.unpack("<I", self._take(4, 4))[0])

    def byte(self) -> int:
        return self._take(1, 1)[0]

    def strings(self) -> list[bytes]:
        count = self._count()
        if count > self.left:
            raise LayoutError(f"{count} joints in {len(self._data)} bytes")
        return [self._take(self._count(), 1).rstrip(b"\0") for _ in range(count)]

    def doubles(self) -> list[float]:
        count = self._count()
        return list(struct.unpack(f"<{count}d", self._take(8 * count, 8))) if count else []
