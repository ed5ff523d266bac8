"""Connections that hang: what broken clients, scanners and bad intentions leave open at a web server."""

import resource
import socket
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress

SPARE = 300  # file descriptors for everything else


@contextmanager
def hanging(port: int, count: int, source: str = "127.0.0.1") -> Iterator[list[socket.socket]]:
    """`count` connections to a port of this PC: idle, half a header, half a body, a reader of nothing, in turn."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    if soft < count + SPARE:
        resource.setrlimit(resource.RLIMIT_NOFILE, (min(hard, count + SPARE), hard))
    here = f"Host: 127.0.0.1:{port}\r\n"
    kinds = (
        "",
        f"GET /api/state HTTP/1.1\r\n{here}",
        f"POST /api/stop HTTP/1.1\r\n{here}Content-Type: application/json\r\nContent-Length: 2\r\n\r\n{{",
        f"GET /openapi.json HTTP/1.1\r\n{here}\r\n" * 8,
    )
    with ExitStack() as stack:
        opened = []
        for number in range(count):
            one = stack.enter_context(socket.socket())
            one.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 2048)
            one.settimeout(10)
            one.bind((source, 0))
            with suppress(ConnectionError):  # it may have been closed already: that is what the console is there for
                one.connect(("127.0.0.1", port))
                one.sendall(kinds[number % len(kinds)].encode())
            opened.append(one)
        yield opened


def still_open(connections: list[socket.socket]) -> int:
    """How many of them the other side has not closed."""
    found = 0
    for one in connections:
        one.setblocking(False)
        try:
            while one.recv(65536):
                pass
        except BlockingIOError:
            found += 1
        except OSError:
            continue
    return found
