"""Finds processes that exist but do not answer: they are frozen, or their ROS thread hangs.

supervisord sees only processes that end. Each process answers on its health port that it runs; if it has answered once
and then does not for some seconds, it is restarted. Before its first answer, a process has a minute more: it may still
be starting, or have frozen before this thread began. A gateway without a pulse is killed much sooner: a machine waits.
"""

import contextlib
import http.client
import os
import signal
import threading
from collections.abc import Callable, Mapping, Sequence

from tms_config.clock import monotonic
from tms_config.processes import here
from tms_host.supervisor import Running, Supervisor
from tms_reason.errors import TmsError
from tms_runtime.app import App

ROUND_PERIOD = 2.0  # s between rounds; a request costs about a millisecond of both processes
ANSWER_LIMIT = 2.0  # s
PULSE_LIMIT = 3.0  # s without a pulse until a gateway is killed
PULSE_PERIOD = 0.5  # s between checks
OLDER = 2.0  # s; its pulse counts as lost 0.6 s after the last beat, and supervisord counts whole seconds
STARTING = 60.0  # s more for a process that has not answered yet; forty that start at once take 15 s


class Answers:
    """When each process answered last. Pure logic; times are monotonic [s]."""

    def __init__(self, limit: float) -> None:
        self._limit = limit
        self._last: dict[str, tuple[int, float]] = {}  # name -> pid, time

    def frozen(self, name: str, pid: int, answered: bool, now: float) -> bool:
        """Take the result of a request; returns whether the process has been silent for too long."""
        if answered:
            self._last[name] = (pid, now)
            return False
        known = self._last.get(name)
        if known is None or known[0] != pid:
            self._last[name] = (pid, now + STARTING)
            return False
        return now - known[1] > self._limit


class Watchdog:
    """A thread that asks every running process of this PC, and restarts those that are frozen."""

    def __init__(
        self, app: App, running: Callable[[], Sequence[Running]], silent: Callable[[], Mapping[str, float]]
    ) -> None:
        """`running`: processes in supervisord's last answer; `silent`: gateways without a pulse, for how long [s]."""
        self._app, self._running, self._silent = app, running, silent
        self._asked = {row.full: row for row in here(app.site) if row.ours and row.full != app.process.full}
        self._killed: dict[str, int] = {}  # pids by name; supervisord needs up to 1 s to notice
        self._times = Answers(app.site.file.on_loss.frozen)
        if app.site.file.on_loss.frozen:
            threading.Thread(target=self._watch, name="watchdog", daemon=True).start()
            threading.Thread(target=self._watch_gateways, name="gateways", daemon=True).start()

    def _watch(self) -> None:
        supervisor = Supervisor(self._app.site)
        while not self._app.stopping.wait(ROUND_PERIOD):
            for row in self._running():
                if row.state != "RUNNING" or row.name not in self._asked:
                    continue
                if self._times.frozen(row.name, row.pid, self.answers(row.name), monotonic()):
                    self._restart(supervisor, row)

    def answers(self, name: str) -> bool:
        """Whether a process of this PC answers that it runs."""
        row = self._asked[name]
        asked = http.client.HTTPConnection(row.address, row.port, timeout=ANSWER_LIMIT)
        try:
            asked.request("GET", "/healthz")
            return asked.getresponse().status == http.HTTPStatus.OK
        except (OSError, http.client.HTTPException):
            return False
        finally:
            asked.close()

    def _restart(self, supervisor: Supervisor, row: Running) -> None:
        try:
            now = supervisor.process(row.name)
            if (now.state, now.pid) != ("RUNNING", row.pid):  # it was stopped while it was asked
                return
            self._app.log.error("frozen", target=row.name, pid=row.pid, action="restarted")
            supervisor.control("restart", row.name)
        except TmsError as error:
            self._app.log.error("not_restarted", target=row.name, reason=error.reason)

    def _watch_gateways(self) -> None:
        """Kill gateways without a pulse; in a thread of its own, as the other one waits for frozen processes."""
        supervisor = Supervisor(self._app.site)
        while not self._app.stopping.wait(PULSE_PERIOD):
            for name, seconds in self._silent().items():
                if seconds >= PULSE_LIMIT:
                    self._kill(supervisor, name)

    def _kill(self, supervisor: Supervisor, name: str) -> None:
        """Kill a gateway that ran before its pulse was lost; not its successor, which may take long to start."""
        try:
            row = supervisor.process(name)
        except TmsError as error:
            self._app.log.error("not_killed", target=name, reason=error.reason)
            return
        seconds = self._silent().get(name)  # asked again: supervisord may have taken seconds, and the pulse may be back
        if seconds is None:
            return
        older = row.state == "RUNNING" and row.uptime > seconds + OLDER
        if older and row.pid != self._killed.get(name):
            self._killed[name] = row.pid
            self._app.log.error("frozen", target=name, pid=row.pid, action="killed")
            with contextlib.suppress(ProcessLookupError):  # it has just ended
                os.kill(row.pid, signal.SIGKILL)
