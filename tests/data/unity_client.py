"""Speaks the ROS-TCP protocol as the simulator's connector does, byte for byte; shares no code with the bridge."""

import contextlib
import json
import socket
import struct
import threading
import time
from collections.abc import Callable
from typing import Any


def frame(destination: bytes, payload: bytes) -> bytes:
    return struct.pack("<I", len(destination)) + destination + struct.pack("<I", len(payload)) + payload


def text(content: str) -> bytes:
    """A string of the simulator: its NUL counts."""
    return content.encode() + b"\0"


class Unity:
    """A connection: keep-alive first and after every silent second, one thread that reads."""

    def __init__(self, port: int, beats: bool = True, reads: bool = True) -> None:
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=10)
        self.frames: list[tuple[str, bytes]] = []
        self.closed = threading.Event()
        self._said = time.monotonic()
        self._lock = threading.Lock()
        self.raw(bytes(8))
        if reads:
            threading.Thread(target=self._read, daemon=True).start()
        if beats:
            threading.Thread(target=self._beat, daemon=True).start()

    def raw(self, data: bytes) -> None:
        with self._lock:
            self.socket.sendall(data)
            self._said = time.monotonic()

    def message(self, topic: str, cdr: bytes) -> None:
        self.raw(frame(text(topic), cdr))

    def command(self, name: str, **fields: Any) -> None:
        self.raw(frame(text(name), text(json.dumps(fields))))

    def close(self) -> None:
        self.closed.set()
        with contextlib.suppress(OSError):  # the other side may have closed it
            self.socket.shutdown(socket.SHUT_RDWR)  # a close alone waits for the thread that reads
        self.socket.close()

    def got(self, destination: str) -> list[bytes]:
        return [payload for name, payload in list(self.frames) if name == destination]

    def errors(self) -> list[str]:
        return [json.loads(payload)["text"] for payload in self.got("__error")]

    def until(self, there: Callable[[], Any], what: str, limit: float = 40.0) -> None:
        deadline = time.monotonic() + limit
        while not there():
            assert time.monotonic() < deadline, f"no {what} within {limit} s; got {self.frames[-5:]}"
            time.sleep(0.01)

    def _beat(self) -> None:
        while not self.closed.wait(0.2):
            if time.monotonic() - self._said > 1.0:
                try:
                    self.raw(bytes(8))
                except OSError:
                    return

    def _exactly(self, count: int) -> bytes:
        data = b""
        while len(data) < count:
            piece = self.socket.recv(count - len(data))
            if not piece:
                raise ConnectionError
            data += piece
        return data

    def _read(self) -> None:
        self.socket.settimeout(None)
        try:
            while True:
                (length,) = struct.unpack("<I", self._exactly(4))
                name = self._exactly(length).decode()
                (length,) = struct.unpack("<I", self._exactly(4))
                self.frames.append((name, self._exactly(length)))
        except (OSError, ConnectionError):
            self.closed.set()
