"""Answers of services that must not get lost.

A client sees a server a moment before the server sees the client's reader, longer while a whole site starts. rmw waits
0.1 s for the reader, then drops the answer with a warning and nothing else; the client would wait in vain.
"""

import warnings
from collections.abc import Callable
from typing import Any

from rclpy.exceptions import InvalidHandle

DROPPED = "failed to send response"
AGAIN = 0.5  # s until the next attempt: each may hold the executor for 0.1 s
ATTEMPTS = 6  # clients wait 5 s, and ask again themselves if they must

Later = Callable[[float, Callable[[], None]], None]


def send_surely(service: Any, later: Later) -> None:
    """Have a service send its answers again when rmw drops them, and nothing for None; on the executor thread."""
    send = service.send_response

    def attempt(response: Any, header: Any, left: int) -> None:
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            try:
                send(response, header)
            except InvalidHandle:  # the service was taken away meanwhile, and an exception would end the executor
                return
        dropped = [one for one in told if DROPPED in str(one.message)]
        if dropped and left > 1:
            later(AGAIN, lambda: attempt(response, header, left - 1))
        for one in told if not dropped or left == 1 else ():
            warnings.warn_explicit(one.message, one.category, one.filename, one.lineno)

    service.send_response = lambda response, header: None if response is None else attempt(response, header, ATTEMPTS)
