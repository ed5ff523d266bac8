"""A mesh that only pretends: services are functions, and there is no ROS."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import click
import pytest
from click.testing import CliRunner, Result

from tms_cli import session
from tms_reason.errors import RosError, TmsError
from tms_reason.reason import Foreign


class FakeMesh:
    """Stands for the node and for every service; `answers` maps a service's name to its answer."""

    def __init__(self) -> None:
        self.answers: dict[str, Any] = {}
        self.asked: list[tuple[str, dict[str, Any]]] = []
        self.received: dict[str, Callable[[Any], None]] = {}
        self.told: dict[str, Any] = {}  # what is on latched topics
        self.action: Any = None  # what `peer` returns

    def call(self, service_type: Any, name: str, **fields: Any) -> Any:
        self.asked.append((name, fields))
        service_type.Request(**fields)  # fields and their types fit
        if name not in self.answers:
            raise RosError(Foreign(f"service {name} is not there"), "NO_SERVER")
        answer = self.answers[name]
        answer = answer(**fields) if isinstance(answer, Callable) else answer
        if isinstance(answer, TmsError):
            raise answer
        return answer

    def peer(self, action_type: Any, name: str) -> Any:
        return self.action

    def subscribe(self, message_type: Any, topic: str, received: Callable[[Any], None], latched: bool = False) -> None:
        self.received[topic] = received
        if topic in self.told:
            received(self.told[topic])


@pytest.fixture
def mesh(monkeypatch: pytest.MonkeyPatch) -> FakeMesh:
    fake = FakeMesh()

    @contextmanager
    def ros() -> Iterator[FakeMesh]:
        yield fake

    monkeypatch.setattr(session, "ros", ros)
    monkeypatch.setattr(session, "call", lambda node, *args, **fields: node.call(*args, **fields))
    return fake


@pytest.fixture
def tms(monkeypatch: pytest.MonkeyPatch) -> Callable[..., Result]:
    """Run a verb as `tms` does; an error that main() reports is left in `exception`."""
    monkeypatch.delenv("TMS_SITE", raising=False)

    def run(command: click.Command, *words: str) -> Result:
        return CliRunner().invoke(command, [str(word) for word in words])

    return run
