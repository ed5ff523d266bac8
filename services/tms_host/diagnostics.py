"""/diagnostics for the tools of ROS (rqt_robot_monitor, diagnostic_aggregator): a status for each process here."""

import threading
from collections.abc import Callable, Mapping

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue

from tms_config.processes import Process, table
from tms_host.reasons import NoPulse
from tms_host.supervisor import Running
from tms_reason.reason import Reason
from tms_reason.texts import text
from tms_runtime import metrics
from tms_runtime.app import App

PUBLISH_PERIOD = 1.0  # s between messages
READY_CHECK_PERIOD = 5.0  # s between the readiness checks of a process: each costs a few milliseconds
ANSWER = 0.5  # s
OK, WARN, ERROR, STALE = 0, 1, 2, 3


class Diagnostics:
    """Publishes in a thread of its own; `rows` and `restarts` are supervisord's last answer."""

    def __init__(self, app: App, silent: Callable[[], Mapping[str, float]]) -> None:
        """`silent` gives the gateways without a pulse, and for how long [s]."""
        self._app, self._silent = app, silent
        self._table = {row.full: row for row in table(app.site)}
        self._publisher = app.ros.publisher(DiagnosticArray, "/diagnostics")
        self._reasons: dict[str, Reason | None] = {}
        self._rows: list[Running] = []
        self._restarts: dict[str, int] = {}
        threading.Thread(target=self._publish, name="diagnostics", daemon=True).start()

    def update(self, rows: list[Running], restarts: dict[str, int]) -> None:
        """Take supervisord's answer, from the thread that asks it."""
        self._rows, self._restarts = rows, dict(restarts)

    def _publish(self) -> None:
        looks = 0
        while not self._app.stopping.wait(PUBLISH_PERIOD):
            if not self._publisher.get_subscription_count():
                looks = 0  # the next reader gets fresh answers
                continue
            rows = self._rows
            if looks % round(READY_CHECK_PERIOD / PUBLISH_PERIOD) == 0:
                self._reasons = {row.name: self._ask(row) for row in rows if row.state == "RUNNING"}
            looks += 1
            message = DiagnosticArray(status=[self._status(row) for row in rows])
            message.header.stamp = self._app.ros.now()
            self._publisher.publish(message)

    def _ask(self, row: Running) -> Reason | None:
        process = self._table.get(row.name)
        if process is None or not process.ours:
            return None
        return metrics.unready(process, ANSWER)

    def _status(self, row: Running) -> DiagnosticStatus:
        level, words = judge(row, self._table.get(row.name), self._reasons.get(row.name), self._silent().get(row.name))
        values = {"state": row.state, "pid": row.pid, "restarts": self._restarts.get(row.name, 0),
                  "uptime_seconds": round(row.uptime)}  # fmt: skip
        return DiagnosticStatus(
            level=bytes([level]), name=f"tms: {row.name}", hardware_id=row.name.partition(":")[0], message=words,
            values=[KeyValue(key=key, value=str(value)) for key, value in values.items()],
        )  # fmt: skip


def judge(row: Running, process: Process | None, reason: Reason | None, silent: float | None = None) -> tuple[int, str]:
    """Level and English text of one process; a subtask that no task has named yet is OK.

    `silent`: for how long a gateway has had no pulse [s]; None while it has one.
    """
    if silent is not None:
        return ERROR, text(NoPulse(silent, row.name), "en")
    if row.state == "RUNNING":
        return (OK, "ready") if reason is None else (WARN, text(reason, "en"))
    if row.state == "STARTING":
        return WARN, "starting"
    if row.state == "STOPPED":
        waits = process is not None and not process.autostart
        return (OK, "starts when a task names it") if waits else (STALE, "stopped")
    return ERROR, f"{row.state}: {row.detail}"
