"""When a process ends by itself."""

import threading
import time
from contextlib import ExitStack

import pytest
import structlog

from tms_config.config import load_site
from tms_config.processes import find
from tms_reason import wire
from tms_runtime import run


class Stop(threading.Event):
    """Waits of which some take longer than they should: the process did not run."""

    def __init__(self, patch: pytest.MonkeyPatch, takes: list[float]) -> None:
        super().__init__()
        self.now, self.takes = 100.0, takes
        patch.setattr(time, "monotonic", lambda: self.now)

    def wait(self, timeout: float | None = None) -> bool:
        if not self.takes:
            return True
        self.now += self.takes.pop(0)
        return False


def test_a_process_that_stood_still_for_long_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    stop, failed = (
        Stop(monkeypatch, [run.END_CHECK_PERIOD, run.FORGOTTEN + 0.1, run.END_CHECK_PERIOD]),
        threading.Event(),
    )
    run._wait_for_end(stop, failed, structlog.stdlib.get_logger("test"))
    assert failed.is_set()


def test_one_that_stood_still_for_a_moment_goes_on(monkeypatch: pytest.MonkeyPatch) -> None:
    stop, failed = (
        Stop(
            monkeypatch,
            [run.END_CHECK_PERIOD, run.END_CHECK_PERIOD + 2.2, run.END_CHECK_PERIOD + 2.2, run.END_CHECK_PERIOD],
        ),
        threading.Event(),
    )
    run._wait_for_end(stop, failed, structlog.stdlib.get_logger("test"))
    assert not failed.is_set() and not stop.takes


def test_one_that_has_failed_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    stop, failed = Stop(monkeypatch, [run.END_CHECK_PERIOD] * 3), threading.Event()
    failed.set()
    run._wait_for_end(stop, failed, structlog.stdlib.get_logger("test"))
    assert len(stop.takes) == 2


def test_all_reasons_are_known_before_the_executor_can_receive_one(monkeypatch: pytest.MonkeyPatch) -> None:
    """To import them takes long enough for others to take a process for lost."""
    order: list[str] = []

    class Refused(Exception):
        pass

    def node(*_: object, **__: object) -> None:
        order.append("node")
        raise Refused

    monkeypatch.setattr(wire, "load", lambda: order.append("reasons"))
    monkeypatch.setattr("tms_ros.node.Ros", node)
    monkeypatch.setattr(run, "Health", lambda *_, **__: None)
    monkeypatch.setattr(run.log, "setup", lambda *_, **__: None)
    monkeypatch.setattr(run.signal, "signal", lambda *_: None)
    site = load_site("yard")
    with pytest.raises(Refused), ExitStack() as leaving:
        run._serve(site, find(site, "tms:sp"), leaving)
    assert order == ["reasons", "node"]
