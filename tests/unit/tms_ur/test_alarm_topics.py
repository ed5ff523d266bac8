"""What host agents tell reaches the alarms, and the rules are judged without a console."""

from collections.abc import Callable
from typing import Any

from std_msgs.msg import Bool

from tms_ur.alarm_topics import listen
from tms_ur.board import Board


class FakeRos:
    """Keeps who listens, and what is done all the time."""

    def __init__(self) -> None:
        self.callbacks: dict[str, Callable[[Any], None]] = {}
        self.steps: list[Callable[[], object]] = []

    def subscribe(self, kind: type, topic: str, callback: Callable[[Any], None], latched: bool) -> None:
        assert latched, "what was told before this console began counts"
        self.callbacks[topic] = callback

    def poll_in_thread(self, seconds: float, step: Callable[[], object], name: str) -> None:
        self.steps.append(step)


def test_topics_become_alarms_also_while_no_console_is_open() -> None:
    now = [100.0]
    board, ros = Board([], lambda: now[0]), FakeRos()
    listen(ros, ["zx200"], board, "")  # type: ignore[arg-type]
    board.put_runs([])
    board.put_inputs({"pile": "silent", "rain": "alive"})
    ros.steps[0]()
    now[0] += 4
    board.put_runs([])
    board.put_inputs({"pile": "silent", "rain": "alive"})
    ros.callbacks["/zx200/rc/standby"](Bool(data=True))
    now[0] += 1
    found = [(alarm.name, alarm.subject) for alarm in board.snapshot().alarms]
    assert found == [("TmsGatewayLost", "zx200"), ("TmsSensingStale", "pile")]


def test_prometheus_is_asked_where_the_site_names_it() -> None:
    """It is not there, and that is told beside what is judged here."""
    board, ros = Board([]), FakeRos()
    listen(ros, [], board, "http://127.0.0.1:9")  # type: ignore[arg-type]
    ros.steps[-1]()
    assert [alarm.name for alarm in board.snapshot().alarms] == ["PrometheusAway"]
