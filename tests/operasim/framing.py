"""Frames of the ROS-TCP protocol, from the side of the simulator. Pure."""

import json
import struct

KEEP_ALIVE = bytes(8)
LIMIT = 1 << 26  # bytes of a part; more is no frame


class FrameError(Exception):
    """The bytes are no frames."""


def frame(destination: str, payload: bytes) -> bytes:
    """A message: the NUL of its topic counts."""
    name = destination.encode() + b"\0"
    return struct.pack("<I", len(name)) + name + struct.pack("<I", len(payload)) + payload


def command(name: str, **fields: object) -> bytes:
    """A system command."""
    return frame(name, json.dumps(fields).encode() + b"\0")


class Splitter:
    """Cuts what arrives into frames: destination and payload; keep-alives are left out."""

    def __init__(self) -> None:
        self._buffer = bytearray()

    def feed(self, data: bytes) -> list[tuple[str, bytes]]:
        """The frames that these bytes complete.

        Raises:
            FrameError: a length is no length.
        """
        self._buffer += data
        found = []
        while (end := self._end()) is not None:
            (name,) = struct.unpack_from("<I", self._buffer)
            destination, payload = self._buffer[4 : 4 + name], bytes(self._buffer[8 + name : end])
            del self._buffer[:end]
            if destination:
                found.append((destination.decode("ascii", "replace"), payload))
        return found

    def _end(self) -> int | None:
        """Where the first frame ends, None while it is incomplete."""
        end = 0
        for _ in range(2):
            if len(self._buffer) < end + 4:
                return None
            (length,) = struct.unpack_from("<I", self._buffer, end)
            if length > LIMIT:
                raise FrameError(f"a part of {length} bytes")
            end += 4 + length
        return end if len(self._buffer) >= end else None
