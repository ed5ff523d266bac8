"""A client of the control port of the stand-in of OperaSim-PhysX."""

import json
import socket
from typing import Any


class ControlClient:
    """A command is a line, its answer a line of JSON."""

    def __init__(self, port: int, limit: float) -> None:
        self._socket = socket.create_connection(("127.0.0.1", port), timeout=limit)
        self._answers = self._socket.makefile("r")

    def command(self, line: str) -> dict[str, Any]:
        self._socket.sendall(line.encode() + b"\n")
        answer = json.loads(self._answers.readline())
        assert isinstance(answer, dict)
        return answer

    def close(self) -> None:
        self._answers.close()
        self._socket.close()
