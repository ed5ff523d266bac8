"""The frames of the ROS-TCP protocol: two lengths (uint32, little-endian), each with its bytes. Pure logic."""

import struct
from dataclasses import dataclass

DESTINATION_LIMIT = 1024  # bytes; ROS names are far shorter
_LENGTH = struct.Struct("<I")


class FrameError(Exception):
    """The stream is no longer readable: the bytes are no frame, and the begin of the next frame is unknown."""


@dataclass(frozen=True)
class Frame:
    """One message or command; both parts are empty in a keep-alive."""

    destination: str
    payload: bytes

    @property
    def keep_alive(self) -> bool:
        return not self.destination and not self.payload


def encode(destination: str, payload: bytes) -> bytes:
    """Encode a frame for the simulator: without the NUL that the simulator itself sends."""
    name = destination.encode()
    return b"".join((_LENGTH.pack(len(name)), name, _LENGTH.pack(len(payload)), payload))


class Splitter:
    """Cuts a stream into frames, whatever pieces it arrives in. It keeps at most one frame."""

    def __init__(self, payload_limit: int) -> None:
        """`payload_limit` [bytes] bounds what one frame may hold."""
        self._limit = payload_limit
        self._buffer = bytearray()

    @property
    def pending(self) -> int:
        """Received bytes of an incomplete frame."""
        return len(self._buffer)

    def feed(self, data: bytes) -> list[Frame]:
        """The frames that `data` completes.

        Raises:
            FrameError: a length is beyond its limit, or the destination is no text.
        """
        self._buffer += data
        found = []
        while (frame := self._next()) is not None:
            found.append(frame)
        return found

    def _next(self) -> Frame | None:
        name_end = self._part(0, DESTINATION_LIMIT, "destination")
        if name_end is None:
            return None
        end = self._part(name_end, self._limit, "message")
        if end is None:
            return None
        name, payload = bytes(self._buffer[4:name_end]), bytes(self._buffer[name_end + 4 : end])
        del self._buffer[:end]
        try:
            return Frame(name.rstrip(b"\0").decode(), payload)
        except UnicodeDecodeError as error:
            raise FrameError(f"a destination that is no text: {name[:40]!r}") from error

    def _part(self, start: int, limit: int, what: str) -> int | None:
        """Where a length and its bytes end; None until all have arrived. The length is checked at once."""
        if len(self._buffer) < start + 4:
            return None
        (length,) = _LENGTH.unpack_from(self._buffer, start)
        if length > limit:
            raise FrameError(f"a {what} of {length} bytes, the limit is {limit}: is that a ROS-TCP client?")
        end = start + 4 + int(length)
        return end if len(self._buffer) >= end else None
