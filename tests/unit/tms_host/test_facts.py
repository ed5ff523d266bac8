"""Metrics of a PC's processes, from real /proc and a made-up supervisord."""

import os
from pathlib import Path

from prometheus_client import CollectorRegistry

from tms_config.processes import Process
from tms_host import facts
from tms_host.diagnostics import ERROR, OK, STALE, WARN, judge
from tms_host.facts import Clock, HostCollector
from tms_host.supervisor import Running
from tms_machine.reasons import WaitingFor

NEVER = 2**22 + 1  # above pid_max


def collected(tmp_path: Path, rows: list[Running], clock: Clock | None = None) -> CollectorRegistry:
    registry = CollectorRegistry()
    found = HostCollector(tmp_path, lambda: clock)
    found.update(rows, {"tms:ts": 2})
    registry.register(found)
    return registry


def test_a_running_process_is_measured() -> None:
    registry = collected(Path("/tmp"), [Running("tms:ts", "RUNNING", os.getpid(), 1.0, "")])
    labels = {"program": "tms:ts"}
    assert registry.get_sample_value("tms_host_program_up", labels) == 1
    assert registry.get_sample_value("tms_host_program_restarts_total", labels) == 2
    for name in ("cpu_seconds_total", "resident_memory_bytes", "open_fds", "start_time_seconds"):
        assert (registry.get_sample_value(f"tms_host_program_{name}", labels) or 0) > 0, name


def test_a_process_that_has_just_ended_is_left_out_and_harms_nobody(tmp_path: Path) -> None:
    rows = [Running("tms:ts", "RUNNING", NEVER, 1.0, ""), Running("tms:db", "FATAL", 0, 0.0, "exited too quickly")]
    registry = collected(tmp_path, rows)
    assert registry.get_sample_value("tms_host_program_open_fds", {"program": "tms:ts"}) is None
    assert registry.get_sample_value("tms_host_program_state", {"program": "tms:db", "state": "FATAL"}) == 1
    assert registry.get_sample_value("tms_host_program_up", {"program": "tms:db"}) == 0


def test_a_state_that_is_over_leaves_no_series(tmp_path: Path) -> None:
    registry = CollectorRegistry()
    found = HostCollector(tmp_path, lambda: None)
    registry.register(found)
    for state in ("BACKOFF", "RUNNING"):
        found.update([Running("tms:ts", state, 0, 0.0, "")], {})
    assert registry.get_sample_value("tms_host_program_state", {"program": "tms:ts", "state": "BACKOFF"}) is None


def test_the_clock_is_told_when_the_kernel_tells_it(tmp_path: Path) -> None:
    registry = collected(tmp_path, [], Clock(False, 16.0, 0.002))
    assert registry.get_sample_value("tms_host_clock_synchronised") == 0
    assert registry.get_sample_value("tms_host_clock_offset_seconds") == 0.002
    assert collected(tmp_path, []).get_sample_value("tms_host_clock_synchronised") is None


def test_the_kernel_can_be_asked() -> None:
    found = facts.clock()
    assert found is None or (found.error >= 0 and abs(found.offset) < 10)


def test_what_diagnostics_say_of_a_process() -> None:
    def row(state: str) -> Running:
        return Running("zx200:dig", state, 1, 1.0, "exited too quickly")

    subtask = Process("zx200", "dig", "machine", "m", 1, "", autostart=False)
    service = Process("tms", "ts", "cps", "m", 1, "")
    assert judge(row("RUNNING"), service, None) == (OK, "ready")
    assert judge(row("RUNNING"), service, WaitingFor("tms:db")) == (WARN, "waiting for tms:db")
    assert judge(row("RUNNING"), service, None, 4.2) == (
        ERROR,
        "no pulse for 4.2 s: the host agent keeps the machine stopped",
    )
    assert judge(row("STOPPED"), subtask, None)[0] == OK
    assert judge(row("STOPPED"), service, None)[0] == STALE
    assert judge(row("FATAL"), service, None) == (ERROR, "FATAL: exited too quickly")
