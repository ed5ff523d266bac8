"""A scripted endpoint on a loopback socket: it accepts one connection at a time, and keeps the frames that come."""

import json
import socket
import struct

from unity_client import frame


def endpoint_frame(destination: str, payload: bytes) -> bytes:
    """A frame of the endpoint: without the NUL that the simulator itself sends."""
    return frame(destination.encode(), payload)


def handshake(version: str = "v0.7.0", protocol: str = "ROS2", name: str = "__handshake") -> bytes:
    fields = {"version": version, "metadata": json.dumps({"protocol": protocol})}
    return endpoint_frame(name, json.dumps(fields).encode())


class FakeEndpoint:
    """Not blocking: `look` takes what has come."""

    def __init__(self) -> None:
        self.server = socket.create_server(("127.0.0.1", 0))
        self.server.setblocking(False)
        self.address: tuple[str, int] = self.server.getsockname()
        self.client: socket.socket | None = None
        self.connections = 0
        self.frames: list[tuple[bytes, bytes]] = []  # raw, with their NULs; keep-alives too
        self._data = b""

    def look(self) -> None:
        try:
            if self.client is None:
                self.client, _ = self.server.accept()
                self.client.setblocking(False)
                self.connections += 1
                self._data = b""
            data = self.client.recv(1 << 20)
        except BlockingIOError:
            return
        if not data:
            self.drop()
        self._data += data
        while (frame := self._frame()) is not None:
            self.frames.append(frame)

    def say(self, data: bytes) -> None:
        assert self.client is not None
        self.client.sendall(data)

    def drop(self) -> None:
        assert self.client is not None
        self.client.close()
        self.client = None

    def close(self) -> None:
        if self.client is not None:
            self.client.close()
        self.server.close()

    def commands(self) -> list[tuple[str, str]]:
        """Commands and their topics."""
        return [
            (name[:-1].decode(), json.loads(payload[:-1]).get("topic", ""))
            for name, payload in self.frames
            if name.startswith(b"__")
        ]

    def messages(self, topic: str) -> list[bytes]:
        return [payload for name, payload in self.frames if name == topic.encode() + b"\0"]

    def keep_alives(self) -> int:
        return self.frames.count((b"", b""))

    def _frame(self) -> tuple[bytes, bytes] | None:
        if len(self._data) < 4:
            return None
        (first,) = struct.unpack_from("<I", self._data)
        if len(self._data) < 8 + first:
            return None
        (second,) = struct.unpack_from("<I", self._data, 4 + first)
        if len(self._data) < 8 + first + second:
            return None
        frame = self._data[4 : 4 + first], self._data[8 + first : 8 + first + second]
        self._data = self._data[8 + first + second :]
        return frame
