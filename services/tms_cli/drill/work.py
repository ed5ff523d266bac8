"""The run that the drill disturbs: begun, followed, resumed when its scheduler was lost, and ended."""

import time
from collections.abc import Sequence
from typing import Any

from tms_msg_ts.action import ExecuteTask
from tms_msg_ts.srv import CancelRun

from tms_cli import mesh, session
from tms_cli.commands import rearm
from tms_core.config import Site
from tms_core.errors import TmsError
from tms_core.ros import Call, Ros

ARM_LIMIT = 15.0  # s for the machine to be armed again
SERVER_LIMIT = 20.0  # s for the scheduler to be there
END_LIMIT = 20.0  # s for a cancelled run to end
LOOK = 0.1  # s


class Work:
    """One run after another of one task; `leaf` is the number of the leaf that is RUNNING, -1 before the first."""

    def __init__(self, node: Ros, site: Site, machine: str, task_id: int, paths: Sequence[str]) -> None:
        self._node, self._site, self._machine, self._task, self._paths = node, site, machine, task_id, paths
        self._peer = node.peer(ExecuteTask, "/tms/execute_task")
        self._call: Call | None = None
        self._run_id = ""
        self.leaf = -1
        self.losses = 0  # of processes during the goal of the present leaf
        self.lost = False  # its scheduler was lost: whether it waits to be resumed tells the history

    def outcome(self) -> str | None:
        """How the run ended, as its client is told; None while it goes on."""
        call = self._call
        if call is None or call.outcome is None or self.lost:
            return None
        return str(getattr(call.result, "outcome", "refused"))

    def idle(self) -> bool:
        """Whether nothing runs, and nothing waits to be resumed."""
        return not self.lost and (self._call is None or self._call.outcome is not None)

    def interrupted(self) -> bool:
        """Whether the run waits for somebody to resume it."""
        from tms_cli.commands.runs import has_ended, recent

        try:
            run = recent(self._node, self._run_id)
        except TmsError:
            return False  # the database may be what was hit
        return run is not None and has_ended(run) and run.state == "interrupted"

    def begin(self, resume: bool = False) -> None:
        """Start the task, or let its interrupted run go on.

        Raises:
            TmsError: the mesh does not get ready, the machine cannot be armed, or the run does not begin.
        """
        mesh.wait_ready(self._site, lambda text: None)
        self._arm()
        self._peer.wait_ready(SERVER_LIMIT)
        goal = ExecuteTask.Goal(resume=self._run_id) if resume else ExecuteTask.Goal(task_id=self._task)
        self.leaf, self.losses, self.lost = -1, 0, False
        self._call = self._peer.send(goal, on_feedback=self._heard)

    def end(self) -> None:
        """Cancel the run, or give it up when its scheduler was lost."""
        call = self._call
        if call is None:
            return
        self._peer.cancel(call)
        call.wait_for(lambda: call.outcome is not None, END_LIMIT)
        if self.lost and self.interrupted():
            session.call(self._node, CancelRun, "/tms/abandon_run", run_id=self._run_id)

    def scheduler_lost(self) -> None:
        """The client's side of it: nothing more will be heard of this goal."""
        self.lost = True
        self._peer.lost()

    def _heard(self, feedback: Any) -> None:
        self._run_id = feedback.run_id or self._run_id
        if feedback.running_leaf in self._paths:
            leaf = self._paths.index(feedback.running_leaf)
            self.leaf, self.losses = leaf, self.losses if leaf == self.leaf else 0

    def _arm(self) -> None:
        deadline = time.monotonic() + ARM_LIMIT
        while True:
            try:
                rearm.ask(self._node, self._machine, rearm.ask(self._node, self._machine).token)
                return
            except TmsError as error:
                if error.code == "NOT_STOPPED":
                    return
                if time.monotonic() > deadline:
                    raise
            time.sleep(LOOK)
