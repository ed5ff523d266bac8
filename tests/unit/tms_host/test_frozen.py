"""When a process that does not answer counts as frozen."""

import threading
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
import structlog
import yaml

from tms_config.config import load_site
from tms_config.processes import find
from tms_host.frozen import STARTING, Answers, Watchdog
from tms_host.supervisor import Running
from tms_runtime.metrics import Health


def test_a_process_that_has_answered_may_be_silent_for_so_long() -> None:
    answers = Answers(10.0)
    assert not answers.frozen("zx200:rc", 7, False, 100.0)  # still starting
    assert not answers.frozen("zx200:rc", 7, True, 101.0)
    assert not answers.frozen("zx200:rc", 7, False, 110.0)
    assert answers.frozen("zx200:rc", 7, False, 112.0)


def test_a_new_process_starts_anew() -> None:
    answers = Answers(10.0)
    answers.frozen("zx200:rc", 7, True, 100.0)
    assert not answers.frozen("zx200:rc", 8, False, 200.0)


def test_a_process_that_froze_while_nobody_watched_is_found_too() -> None:
    answers = Answers(10.0)
    assert not answers.frozen("zx200:rc", 7, False, 100.0)
    assert not answers.frozen("zx200:rc", 7, False, 100.0 + STARTING + 10.0)
    assert answers.frozen("zx200:rc", 7, False, 100.0 + STARTING + 11.0)


@pytest.fixture
def app(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.setenv("TMS_PC", "cps")
    file = tmp_path / "yard.yaml"
    file.write_text(yaml.safe_dump({
        "name": "yard", "domain": 80, "ports": {"metrics": 29410}, "on_loss": {"frozen": 0},
        "pcs": {"cps": {"address": "127.0.0.9"}}, "services": {"db": {}, "host": {}},
    }))  # fmt: skip
    site = load_site(str(file))
    return SimpleNamespace(
        site=site,
        process=find(site, "tms:host_cps"),
        stopping=threading.Event(),
        log=structlog.stdlib.get_logger("test"),
    )


def test_a_process_is_asked_at_the_address_of_its_pc(app: Any) -> None:
    watchdog = Watchdog(app, list, dict)
    assert not watchdog.answers("tms:db")
    health = Health("127.0.0.9", find(app.site, "tms:db").port, unready=lambda: None)
    try:
        assert watchdog.answers("tms:db")
    finally:
        health.close()


@pytest.mark.parametrize(
    ("state", "pid", "did"), [("RUNNING", 7, ["tms:db"]), ("STOPPING", 7, []), ("STOPPED", 0, []), ("RUNNING", 8, [])]
)
def test_what_somebody_has_stopped_meanwhile_stays_so(app: Any, state: str, pid: int, did: list[str]) -> None:
    restarted: list[str] = []
    supervisor: Any = SimpleNamespace(
        process=lambda name: Running(name, state, pid, 5.0, ""), control=lambda _, name: restarted.append(name)
    )
    Watchdog(app, list, dict)._restart(supervisor, Running("tms:db", "RUNNING", 7, 5.0, ""))
    assert restarted == did


@pytest.mark.parametrize(
    ("state", "uptime", "silent", "killed"),
    [
        ("RUNNING", 60.0, 3.0, [7]),
        ("RUNNING", 4.0, 3.0, []),  # its successor, which may take long to start
        ("RUNNING", 6.0, 5.0, []),  # the same, but supervisord took 2 s to answer
        ("RUNNING", 60.0, None, []),  # it is back meanwhile
        ("STOPPING", 60.0, 3.0, []),
    ],
)
def test_only_a_gateway_that_once_gave_a_pulse_is_killed_without_one(
    app: Any, state: str, uptime: float, silent: float | None, killed: list[int], monkeypatch: pytest.MonkeyPatch
) -> None:
    """And once, though supervisord takes a while to notice."""
    found: list[int] = []
    monkeypatch.setattr("os.kill", lambda pid, number: found.append(pid))
    supervisor: Any = SimpleNamespace(process=lambda name: Running(name, state, 7, uptime, ""))
    watchdog = Watchdog(app, list, lambda: {} if silent is None else {"zx200:rc": silent})
    for _ in range(2):
        watchdog._kill(supervisor, "zx200:rc")
    assert found == killed
