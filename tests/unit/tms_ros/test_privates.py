"""An answer that rmw drops is sent again; other warnings stay what they are."""

import warnings
from collections.abc import Callable
from typing import Any

import pytest
from rclpy.exceptions import InvalidHandle

from tms_ros.privates import ATTEMPTS, send_surely

WARNING = "failed to send response (timeout): client will not receive response"


class Service:
    """Drops the first answers, as rmw does before it has found the client's reader."""

    def __init__(self, drops: int, warning: str = WARNING) -> None:
        self.drops, self.warning, self.sent = drops, warning, 0
        self.later: list[Callable[[], None]] = []
        send_surely(self, lambda seconds, step: self.later.append(step))

    def send_response(self, response: Any, header: Any) -> None:
        self.sent += 1
        if self.sent <= self.drops:
            warnings.warn(self.warning, RuntimeWarning, stacklevel=1)

    def end(self) -> None:
        while self.later:
            self.later.pop(0)()


def test_an_answer_is_sent_once() -> None:
    service = Service(0)
    service.send_response("answer", "header")
    service.end()
    assert service.sent == 1


def test_a_dropped_answer_is_sent_again() -> None:
    service = Service(2)
    service.send_response("answer", "header")
    service.end()
    assert service.sent == 3


def test_an_answer_that_nobody_takes_is_given_up_with_a_warning() -> None:
    service = Service(100)
    service.send_response("answer", "header")
    with pytest.warns(RuntimeWarning, match="failed to send response"):
        service.end()
    assert service.sent == ATTEMPTS


def test_no_answer_is_none() -> None:
    service = Service(0)
    service.send_response(None, "header")
    assert service.sent == 0


def test_another_warning_is_told() -> None:
    service = Service(1, "something else")
    with pytest.warns(RuntimeWarning, match="something else"):
        service.send_response("answer", "header")
    assert (service.sent, service.later) == (1, [])


@pytest.mark.parametrize("drops", [0, 1])
def test_a_service_that_was_taken_away_answers_nobody(drops: int) -> None:
    service = Service(drops)
    send = Service.send_response

    def gone(response: object, header: object) -> None:
        send(service, response, header)
        if service.sent > drops:
            raise InvalidHandle("cannot use Destroyable because destruction was requested")

    del service.send_response
    service.send_response = gone  # type: ignore[method-assign]
    send_surely(service, lambda seconds, step: service.later.append(step))
    service.send_response("answer", "header")
    service.end()
    assert service.sent == drops + 1
