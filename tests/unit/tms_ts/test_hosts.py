"""What the scheduler knows of processes by the last words of their host agents."""

from types import SimpleNamespace
from typing import Any

import pytest
from tms_msg_host.msg import Process, Processes

from tms_ts.hosts import Hosts


def hosts(*messages: Processes) -> Hosts:
    """Which has received these messages."""
    takes: list[Any] = []
    ros = SimpleNamespace(subscribe=lambda kind, topic, take, **_: takes.append(take))
    made = Hosts(ros)  # type: ignore[arg-type]
    for message in messages:
        takes[0](message)
    return made


def told(host: str, *rows: Process) -> Processes:
    return Processes(host=host, processes=list(rows))


def test_processes_of_several_pcs_are_known_by_their_last_message() -> None:
    dig, ts = Process(name="zx200:dig", pid=7, uptime=20.0), Process(name="tms:ts", pid=1)
    known = hosts(told("a", dig), told("b", ts), told("a", Process(name="zx200:dig", pid=8, uptime=5.0)))
    assert known.pid("zx200", "dig") == 8 and known.pid("tms", "ts") == 1
    assert known.pid("zx200", "swing") is None, "no host agent knows it"
    gone = hosts(told("a", dig), told("a"))
    assert gone.pid("zx200", "dig") is None


@pytest.mark.parametrize(("uptime", "age"), [(20.0, 19.0), (0.0, 0.0)])
def test_an_age_is_one_that_the_process_has_at_least(uptime: float, age: float) -> None:
    """Both times of an uptime are whole seconds, so it may be a second too long."""
    known = hosts(told("a", Process(name="zx200:dig", pid=7, uptime=uptime)))
    assert known.age("zx200", "dig") == age
    assert known.age("zx200", "swing") == 0.0
