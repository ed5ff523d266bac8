"""Process `tms:host`: publishes which processes run on this PC, and starts and stops them on request."""

import os
import re
import socket
import threading
from collections.abc import Callable, Mapping
from pathlib import Path

from prometheus_client import REGISTRY
from tms_msg_host.msg import Process, Processes
from tms_msg_host.srv import ControlProcess, ReadLog

from tms_config.clock import monotonic
from tms_host.diagnostics import Diagnostics
from tms_host.facts import HostCollector
from tms_host.frozen import Watchdog
from tms_host.reasons import BadCommand, SupervisordSilent
from tms_host.standby import Standby
from tms_host.supervisor import Running, Supervisor, SupervisorDown
from tms_host.usage import Usage
from tms_reason.errors import TmsError
from tms_reason.wire import to_line
from tms_runtime.app import App

HEARTBEAT = 2.0  # s between messages without changes, so that a dead PC can be distinguished from a quiet one
LOG_BYTES, MAX_LOG_BYTES = 16_384, 262_144
CHILDREN_CHECK_PERIOD = 0.1  # s between checks whether supervisord has other children: its socket has no events
CHANGING = ("STARTING", "STOPPING", "BACKOFF")  # states that end without a new pid


def start(app: App) -> None:
    """Publish /tms/host/processes and serve /tms/host/<host name>/control and /log."""
    standby = Standby(app)
    host = HostAgent(app, standby.silent)
    app.ros.offer_slow(ControlProcess, f"/tms/host/{host.name}/control", host.control)
    app.ros.offer_slow(ReadLog, f"/tms/host/{host.name}/log", host.log)
    app.on_stop(host.close)
    Watchdog(app, lambda: host.rows, standby.silent)
    app.ready_when(lambda: None if host.seen else SupervisordSilent())


def ros_name(host: str) -> str:
    """A host as a part of ROS names: without dashes, and without a digit at the start, as a container's id may have."""
    plain = re.sub(r"[^a-z0-9]", "_", host.lower())
    return plain if plain[:1].isalpha() else f"pc_{plain}"


class Children:
    """Finds out whether a process's children have changed: a call of supervisord costs fifty times as much."""

    def __init__(self, pid: int) -> None:
        self._file = Path(f"/proc/{pid}/task/{pid}/children")
        self._last = ""

    def changed(self) -> bool:
        """Whether the children have changed since the last call; always true where the kernel does not report them."""
        try:
            now = self._file.read_text()
        except FileNotFoundError:
            return True
        changed, self._last = now != self._last, now
        return changed


class HostAgent:
    """Asks supervisord in a thread of its own and publishes changes."""

    def __init__(self, app: App, silent: Callable[[], Mapping[str, float]]) -> None:
        """`silent` gives the gateways without a pulse, and for how long [s]."""
        self.name = ros_name(socket.gethostname())
        self.seen = False
        self.rows: list[Running] = []  # supervisord's last answer
        self._app = app
        self._publisher = app.ros.publisher(Processes, "/tms/host/processes", depth=10, latched=True)
        self._restarts: dict[str, int] = {}
        self._usage = Usage()
        self._pids: dict[str, int] = {}
        self._calls = threading.Lock()  # one RPC connection for control calls
        self._control = Supervisor(app.site)
        self._facts = HostCollector(app.site.state)
        REGISTRY.register(self._facts)
        self._diagnostics = Diagnostics(app, silent)
        self._closing = threading.Event()
        threading.Thread(target=self._watch, name="supervisord", daemon=True).start()

    def close(self) -> None:
        self._closing.set()

    def control(self, request: ControlProcess.Request, response: ControlProcess.Response) -> ControlProcess.Response:
        """start, stop or restart one process of this PC."""
        if request.command not in ("start", "stop", "restart"):
            response.error_code, response.error_msg = BadCommand.code, to_line(BadCommand(request.command))
            return response
        try:
            with self._calls:
                self._control.control(request.command, request.name)
            self._app.log.info(request.command, target=request.name)
        except TmsError as error:
            response.error_code, response.error_msg = error.code, to_line(error.reason)
        return response

    def log(self, request: ReadLog.Request, response: ReadLog.Response) -> ReadLog.Response:
        """The end of a process's log."""
        try:
            with self._calls:
                response.text = self._control.log(request.name, min(request.bytes or LOG_BYTES, MAX_LOG_BYTES))
        except TmsError as error:
            response.error_code, response.error_msg = error.code, to_line(error.reason)
        return response

    def _watch(self) -> None:
        supervisor, children = Supervisor(self._app.site), Children(os.getppid())
        last: list[tuple[str, str, int]] = []
        reported = 0.0
        while not self._closing.wait(CHILDREN_CHECK_PERIOD):
            changing = any(row.state in CHANGING for row in self.rows)
            if not (children.changed() or changing or not self.seen or monotonic() - reported > HEARTBEAT):
                continue
            try:
                rows = supervisor.processes()
            except SupervisorDown:
                self.seen = False
                supervisor = Supervisor(self._app.site)
                continue
            self.seen, self.rows = True, rows
            self._count(rows)
            self._facts.update(rows, self._restarts)
            self._diagnostics.update(rows, self._restarts)
            now = [(row.name, row.state, row.pid) for row in rows]
            if now != last or monotonic() - reported > HEARTBEAT:
                last, reported = now, monotonic()
                self._publisher.publish(self._message(rows))

    def _count(self, rows: list[Running]) -> None:
        for row in rows:
            if row.pid and self._pids.get(row.name, row.pid) != row.pid:
                self._restarts[row.name] = self._restarts.get(row.name, 0) + 1
            if row.pid:
                self._pids[row.name] = row.pid

    def _message(self, rows: list[Running]) -> Processes:
        processes = []
        for row in rows:
            cpu, memory = self._usage.of(row.pid) if row.pid else (0.0, 0)
            processes.append(Process(
                name=row.name, state=row.state, pid=row.pid, restarts=self._restarts.get(row.name, 0),
                uptime=row.uptime, detail=row.detail, cpu=cpu, memory=memory,
            ))  # fmt: skip
        self._usage.keep({row.pid for row in rows})
        return Processes(host=self.name, processes=processes)
