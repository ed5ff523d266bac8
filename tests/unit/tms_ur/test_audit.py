"""Notes reach the database in order, also behind one that cannot be sent."""

import time
from collections.abc import Iterator
from typing import Any

import pytest
from builtin_interfaces.msg import Time
from rclpy.serialization import serialize_message
from tms_msg_db.srv import WriteJournal

from tms_core.errors import RosError
from tms_ur import audit


class FakeRos:
    """Takes what ROS itself can take; `away` is how often the database does not answer first."""

    def __init__(self) -> None:
        self.stored: list[str] = []
        self.away = 0

    def now(self) -> Time:
        return Time()

    def call(self, service_type: Any, name: str, request: WriteJournal.Request) -> WriteJournal.Response:
        if self.away:
            self.away -= 1
            raise RosError("nobody answers")
        serialize_message(request)
        self.stored += [event.node for event in request.events]
        return WriteJournal.Response()


@pytest.fixture
def ros(monkeypatch: pytest.MonkeyPatch) -> FakeRos:
    monkeypatch.setattr(audit, "RETRY", 0.001)
    return FakeRos()


@pytest.fixture
def notes(ros: FakeRos) -> Iterator[audit.Audit]:
    made = audit.Audit(ros)  # type: ignore[arg-type]
    yield made
    made.close()


def wait_for(ros: FakeRos, count: int) -> None:
    deadline = time.monotonic() + 10
    while len(ros.stored) < count and time.monotonic() < deadline:
        time.sleep(0.005)


def test_notes_wait_for_the_database(ros: FakeRos, notes: audit.Audit) -> None:
    ros.away = 3
    for target in ("a", "b"):
        notes.put("mina", "192.0.2.1", "stop", target)
    wait_for(ros, 2)
    assert ros.stored == ["a", "b"]


def test_one_that_cannot_be_sent_is_counted_and_keeps_none_back(
    ros: FakeRos, notes: audit.Audit, caplog: pytest.LogCaptureFixture
) -> None:
    before = audit.LOST._value.get()
    for target in ("a", "half a character: \ud800", "b"):
        notes.put("mina", "192.0.2.1", "set_parameter", target)
    wait_for(ros, 2)
    assert ros.stored == ["a", "b"]
    assert audit.LOST._value.get() == before + 1
    assert "event=audit_lost what=set_parameter" in caplog.text
