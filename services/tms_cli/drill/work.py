"""The run that moves one machine: it begins and ends for each trial; the machine is re-armed as by a person."""

import json

from std_msgs.msg import String
from tms_msg_db.msg import Event
from tms_msg_db.srv import AddTask
from tms_msg_ts.action import ExecuteTask
from tms_msg_ts.srv import CancelRun

from tms_cli import session, stored_records
from tms_cli.commands import rearm
from tms_cli.commands.events import journal
from tms_cli.commands.runs import has_ended, recent
from tms_cli.drill import tasks
from tms_cli.drill.plan import fault_of
from tms_cli.drill.record import time_of
from tms_cli.drill.verdict import INTERRUPTED
from tms_cli.reasons import RunDoesNotEnd
from tms_config.clock import monotonic, sleep
from tms_config.config import Site
from tms_decision.reasons import GoalSent
from tms_reason import wire
from tms_reason.errors import TmsError
from tms_ros.client import Call
from tms_ros.node import Ros
from tms_schedulers.names import responsible
from tms_schedulers.sending import send
from tms_ts.reasons import StateBecause

ARM_LIMIT = 30.0  # s for the machine to be armed again
SERVER_LIMIT = 20.0  # s for the scheduler to be up
END_LIMIT = 20.0  # s for a cancelled run to end
ANSWER_LIMIT = 12.0  # s for the gateway to re-arm
CHECK_PERIOD = 0.2  # s


class Work:
    """The run of one machine."""

    def __init__(self, node: Ros, site: Site, machine: str) -> None:
        from tms_ts import bt

        self._node, self._site, self.machine = node, site, machine
        tree, records = tasks.task(site, machine)
        leaves, model = bt.load(tree).leaf_goals(), site.model_of(machine)
        moving = [leaf for leaf in leaves if model.subtask(leaf.subtask).run != tasks.PLANS]
        self._subtasks = {leaf.path: f"{machine}:{leaf.subtask}" for leaf in moving}
        for name, values in records.items():
            kind = "dynamic" if "waypoints" in values else "static"  # plans are written into it
            stored_records.write(node, (machine, name), values, create=True, type=kind, description="stop drill")
        stored = session.call(node, AddTask, "/tms/db/add_task", task_sequence=tree, description=f"drill {machine}")
        self._task = stored.task_id
        self._peer = node.peer(ExecuteTask, responsible(site, [machine]).named("execute_task"))
        stand_in = site.file.backend == "sim"
        self._fault = node.publisher(String, f"/{machine}/sim/fault") if stand_in else None
        self._call: Call[ExecuteTask.Result, ExecuteTask.Feedback] | None = None
        self._run = ""
        self.lost = False  # its scheduler was lost, so that only the history has its end
        self.untold = False  # the database gave no answer when it was asked last
        self.subtask = self._first()  # the process behind the motion

    def be(self, fault: str) -> None:
        """Set the fault of the stand-in; `none` removes it. The simulator's machines have no faults."""
        if self._fault is None:
            return
        joints = list(self._site.model_of(self.machine).joints)
        self._fault.publish(String(data=json.dumps(fault_of(fault, joints))))

    def begin(self) -> None:
        """Start the task with the machine armed.

        Raises:
            TmsError: it cannot be armed, or the run does not begin.
        """
        self.arm()
        self._peer.wait_ready(SERVER_LIMIT)
        self._run, self.lost, self.untold, self.subtask = "", False, False, self._first()
        goal = ExecuteTask.Goal(task_id=self._task, ignore_warnings=True)
        self._call = send(self._peer, goal, self._received)

    def _first(self) -> str:
        return next(iter(self._subtasks.values()))

    def cancel(self) -> None:
        """Cancel the run; returns at once."""
        if self._call is not None:
            self._peer.cancel(self._call)

    def scheduler_lost(self) -> None:
        """Note the loss of the scheduler: this goal gets no more messages."""
        self.lost = True
        self._peer.mark_lost()

    def outcome(self) -> str | None:
        """How the run ended; None while it goes on."""
        if self.lost:
            return self._recorded() or None
        if self._call is None or self._call.outcome is None:
            return None
        result = self._call.result
        return str(getattr(result, "outcome", "refused"))

    def ended(self) -> bool:
        """Whether the action client has received the end of the run."""
        return self._call is not None and self._call.outcome is not None

    def reason(self) -> str:
        """Why the run ended as it did."""
        return str(getattr(self._call.result, "error_msg", "")) if self._call is not None else ""

    def end(self) -> None:
        """End the run, whatever its state is.

        Raises:
            TmsError: the run does not end.
        """
        self.be("none")
        deadline = monotonic() + END_LIMIT
        self.cancel()
        while self._call is not None and self.outcome() is None:
            if monotonic() > deadline:
                raise TmsError(RunDoesNotEnd(str(self._run)))
            sleep(CHECK_PERIOD)
        if self._recorded() == INTERRUPTED:
            session.of_any(self._node, self._site, CancelRun, "abandon_run", "NO_RUN", run_id=self._run)
        self._call = None

    def _recorded(self) -> str:
        """The end of the run in the history, maybe before the loss of its scheduler; empty: not ended, or unknown."""
        if not self._run:
            return INTERRUPTED if self.lost else ""
        try:
            run = recent(self._node, self._run)
            self.untold = False
        except TmsError:
            self.untold = True
            return ""  # the database may have been hit
        return run.state if run is not None and has_ended(run) else ""

    def history(self) -> list[tuple[float, str]]:
        """When the run entered which states, by its journal: s since 1970, and codes; empty: not known."""
        reasons = [(time_of(row.stamp), wire.known(row.text)) for row in self._events("run")]
        return [(at, (why.state if isinstance(why, StateBecause) else why).code) for at, why in reasons]

    def behind(self, at: float) -> str:
        """The subtask that the run had sent a goal of a motion last by a moment (s since 1970); empty: not known."""
        sent = [row for row in self._events("goal") if isinstance(wire.known(row.text), GoalSent)]
        by_then = [row.node for row in sent if row.node in self._subtasks and time_of(row.stamp) <= at]
        return self._subtasks[by_then[-1]] if by_then else ""

    def _events(self, kind: str) -> list[Event]:
        """The events of one kind in the journal of the run; none where it is not known."""
        if not self._run:
            return []
        try:
            return [row for row in journal(self._node, self._run) if row.kind == kind]
        except TmsError:
            return []  # the database may have been hit

    def _received(self, feedback: ExecuteTask.Feedback) -> None:
        self._run = feedback.run_id or self._run
        self.subtask = self._subtasks.get(feedback.running_leaf, self.subtask)

    def arm(self) -> None:
        """Do both steps of re-arming, again and again until the machine stands.

        Raises:
            TmsError: it cannot be armed.
        """
        deadline = monotonic() + ARM_LIMIT
        while True:
            try:
                self._arm_once()
                return
            except TmsError as error:
                if error.code == rearm.ARMED:
                    return
                if monotonic() > deadline:
                    raise
            sleep(CHECK_PERIOD)

    def _arm_once(self) -> None:
        rearm.ask(self._node, self.machine, rearm.ask(self._node, self.machine).token)
