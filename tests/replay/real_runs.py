"""The runs of a plan on a real site: begun, cancelled, resumed, and what their history tells."""

import threading

from tms_msg_ts.action import ExecuteTask
from tms_msg_ts.srv import CancelRun

from replay.real_site import LIMIT
from simulation.disk import Entry
from tms_cli import session
from tms_cli.commands.events import journal
from tms_reason import wire
from tms_reason.errors import TmsError
from tms_ros.client import Call
from tms_ros.node import Ros

READ = 0.4  # s between looks at the history
RunCall = Call[ExecuteTask.Result, ExecuteTask.Feedback]


class RealRuns:
    """Named as the plan names them. Their history is read in a thread: the database may stand still."""

    def __init__(self, ros: Ros) -> None:
        self._ros, self._peer = ros, ros.peer(ExecuteTask, "/tms/execute_task")
        self._calls: dict[str, RunCall] = {}
        self._ids: dict[str, str] = {}
        self.entries: dict[str, list[Entry]] = {}  # replaced at each look
        self._closing = threading.Event()
        self._reader = threading.Thread(target=self._read_on, name="history")
        self._reader.start()

    def start(self, run: str, task: int) -> None:
        """Begin a run."""
        self._send(run, ExecuteTask.Goal(task_id=task, ignore_warnings=True))

    def resume(self, run: str) -> None:
        """Resume an interrupted run."""
        self._send(run, ExecuteTask.Goal(resume=self._ids[run], ignore_warnings=True))

    def _send(self, run: str, goal: ExecuteTask.Goal) -> None:
        self._peer.wait_ready(LIMIT)
        self._calls[run] = self._peer.send(goal)

    def cancel(self, run: str) -> None:
        """Cancel a run."""
        session.call(self._ros, CancelRun, "/tms/cancel_run", run_id=self._ids[run])

    def scheduler_lost(self) -> None:
        """The scheduler was killed: goals of its last life get no answer any more."""
        self._peer.mark_lost()

    def close(self) -> None:
        """Look for the last time."""
        self._closing.set()
        self._reader.join(LIMIT)

    def _read_on(self) -> None:
        while not self._closing.wait(READ):
            self._read()
        self._read()

    def _read(self) -> None:
        for name, call in list(self._calls.items()):
            told = call.feedback or call.result
            if told is not None and told.run_id:
                self._ids[name] = told.run_id
        try:
            self.entries = {name: self._events(run_id) for name, run_id in self._ids.items()}
        except TmsError:
            return  # the database is held up by its disk: the next look tells it

    def _events(self, run_id: str) -> list[Entry]:
        return [Entry(row.kind, row.node, wire.known(row.text)) for row in journal(self._ros, run_id)]
