"""Which process runs on which host, as the host agents publish it, and how to start one there."""

from collections.abc import Callable

from tms_msg_host.msg import Process, Processes
from tms_msg_host.srv import ControlProcess

from tms_config.clock import monotonic, sleep
from tms_reason.errors import RosError
from tms_reason.reason import Reason
from tms_reason.wire import refusal
from tms_ros.node import Ros
from tms_ts.reasons import CannotStart, ProcessState

START_LIMIT = 10.0  # s
WHOLE = 1.0  # s by which an uptime may be too long: supervisord tells whole seconds


class Hosts:
    """The last message of every host agent."""

    def __init__(self, ros: Ros) -> None:
        self._ros = ros
        self._known: dict[str, tuple[str, Process]] = {}  # process name -> host, row
        ros.subscribe(Processes, "/tms/host/processes", self._received, depth=10, latched=True)

    def _received(self, message: Processes) -> None:
        others = {name: row for name, row in self._known.items() if row[0] != message.host}
        self._known = {**others, **{row.name: (message.host, row) for row in message.processes}}

    def pid(self, machine: str, subtask: str) -> int | None:
        """Pid of a subtask's process, 0 if it does not run; None for a server that no host agent knows."""
        found = self._known.get(f"{machine}:{subtask}")
        return None if found is None else int(found[1].pid)

    def age(self, machine: str, subtask: str) -> float:
        """Seconds for which a subtask's process has run at least; 0 for one that no host agent knows."""
        found = self._known.get(f"{machine}:{subtask}")
        return 0.0 if found is None else max(0.0, float(found[1].uptime) - WHOLE)

    def fatal(self, machine: str, process: str) -> Reason | None:
        """The reason FATAL if supervisord has given up a process."""
        name = f"{machine}:{process}"
        found = self._known.get(name)
        return ProcessState(name, "FATAL") if found and found[1].state == "FATAL" else None

    def trouble(self, machine: str, subtask: str) -> Reason | None:
        """What is wrong with a subtask's process; None if nothing is known."""
        name = f"{machine}:{subtask}"
        found = self._known.get(name)
        if found is None or found[1].state == "RUNNING":
            return None
        return ProcessState(name, found[1].state)

    def start(self, names: list[str], give_up: Callable[[], bool]) -> Reason | None:
        """Have the host agents start processes that do not run; returns why one could not be started.

        Processes that no host agent knows are left alone: they may be servers of another system.
        """
        for name in names:
            host, row = self._known.get(name, ("", None))
            if row is None or row.state in ("RUNNING", "STARTING"):
                continue
            request = ControlProcess.Request(name=name, command="start")
            try:
                answer = self._ros.call(ControlProcess, f"/tms/host/{host}/control", request, START_LIMIT)
            except RosError as error:
                return CannotStart(name, error.reason)
            if answer.error_code:
                return CannotStart(name, refusal(answer.error_code, answer.error_msg))
            if give_up():
                break
        return None

    def wait_known(self, seconds: float) -> None:
        """Wait for a host agent's first message; without a host agent, processes cannot be started on demand."""
        deadline = monotonic() + seconds
        while not self._known and monotonic() < deadline:
            sleep(0.02)
