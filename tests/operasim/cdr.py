"""CDR, little-endian, as ROS 2 messages are on the wire. Pure; bytes are aligned from the end of the header on."""

import struct
from collections.abc import Sequence

HEADER = b"\0\1\0\0"


class CdrError(Exception):
    """The bytes end too early, or are no little-endian CDR."""


class Writer:
    """Builds a message field by field."""

    def __init__(self) -> None:
        self._out = bytearray()

    @property
    def message(self) -> bytes:
        """What was written."""
        return HEADER + bytes(self._out)

    def put(self, code: str, *values: float) -> "Writer":
        """Write numbers of one type: its code of the module `struct`."""
        self._align(struct.calcsize(code))
        self._out += struct.pack(f"<{len(values)}{code}", *values)
        return self

    def stamp(self, seconds: float) -> "Writer":
        """Write a time of the simulator."""
        nanoseconds = round(seconds * 1e9)
        return self.put("i", nanoseconds // 1_000_000_000).put("I", nanoseconds % 1_000_000_000)

    def string(self, text: str) -> "Writer":
        """Write a string; its NUL counts."""
        data = text.encode() + b"\0"
        self.put("I", len(data))
        self._out += data
        return self

    def strings(self, texts: Sequence[str]) -> "Writer":
        """Write a sequence of strings."""
        self.put("I", len(texts))
        for text in texts:
            self.string(text)
        return self

    def doubles(self, values: Sequence[float]) -> "Writer":
        """Write a sequence of float64."""
        self.put("I", len(values))
        return self.put("d", *values) if values else self

    def _align(self, size: int) -> None:
        self._out += bytes(-len(self._out) % size)


class Reader:
    """Reads a message field by field.

    Raises:
        CdrError: it ends before a field does.
    """

    def __init__(self, message: bytes) -> None:
        if message[:2] != HEADER[:2]:
            raise CdrError("no little-endian CDR")
        self._data, self._at = message[4:], 0

    def take(self, code: str, count: int = 1) -> tuple[float, ...]:
        """Read numbers of one type: its code of the module `struct`."""
        size = struct.calcsize(code)
        return struct.unpack(f"<{count}{code}", self._bytes(size * count, size))

    def string(self) -> str:
        """Read a string."""
        return self._bytes(self._count(), 1).rstrip(b"\0").decode("utf-8", "replace")

    def strings(self) -> list[str]:
        """Read a sequence of strings."""
        return [self.string() for _ in range(self._count())]

    def doubles(self) -> list[float]:
        """Read a sequence of float64."""
        count = self._count()
        return list(self.take("d", count)) if count else []

    def _count(self) -> int:
        """A length; what is left bounds it, as each element has a byte at least."""
        (count,) = struct.unpack("<I", self._bytes(4, 4))
        if count > len(self._data) - self._at:
            raise CdrError(f"{count} elements, but {len(self._data) - self._at} bytes are left")
        return int(count)

    def _bytes(self, size: int, align: int) -> bytes:
        begin = self._at + -self._at % align
        if begin + size > len(self._data):
            raise CdrError(f"{size} bytes wanted at {begin}, it has {len(self._data)}")
        self._at = begin + size
        return self._data[begin : self._at]
