"""A small server by which tests and people steer the stand-in: a line is a command, its answer is a line of JSON."""

import json
import socket
from collections.abc import Callable, Sequence
from typing import Any

LONGEST = 200  # bytes of a command

Answer = Callable[[Sequence[str]], dict[str, Any]]


class Refused(Exception):
    """A command is none; the text says why."""


class Control:
    """Listens on the loopback interface. It never blocks."""

    def __init__(self, port: int, answer: Answer) -> None:
        """`answer` carries the words of a command out; it may raise Refused."""
        self._server = socket.create_server(("127.0.0.1", port))
        self._server.setblocking(False)
        self._answer = answer
        self._clients: dict[socket.socket, bytes] = {}

    @property
    def port(self) -> int:
        """Where it listens."""
        return int(self._server.getsockname()[1])

    def waits_for(self) -> list[socket.socket]:
        """What it wants to read from."""
        return [self._server, *self._clients]

    def work(self) -> None:
        """Do what has come."""
        try:
            client, _ = self._server.accept()
            client.setblocking(False)
            self._clients[client] = b""
        except BlockingIOError:
            pass
        for client in list(self._clients):
            try:
                self._read(client)
            except BlockingIOError:
                continue
            except OSError:
                self._forget(client)

    def close(self) -> None:
        """End all."""
        for client in list(self._clients):
            self._forget(client)
        self._server.close()

    def _read(self, client: socket.socket) -> None:
        data = client.recv(LONGEST)
        if not data or len(self._clients[client]) > LONGEST:
            self._forget(client)
            return
        *lines, self._clients[client] = (self._clients[client] + data).split(b"\n")
        for line in lines:
            client.sendall(json.dumps(self._done(line.decode("utf-8", "replace"))).encode() + b"\n")

    def _done(self, line: str) -> dict[str, Any]:
        try:
            return self._answer(line.split())
        except Refused as error:
            return {"error": str(error)}

    def _forget(self, client: socket.socket) -> None:
        client.close()
        del self._clients[client]
