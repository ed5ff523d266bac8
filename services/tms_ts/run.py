"""One run of a task: ticks its tree, records every change, and ends with every machine seen to stand."""

import threading
from collections.abc import Callable, Mapping
from typing import Any

from builtin_interfaces.msg import Time
from prometheus_client import Counter, Histogram
from tms_msg_db.msg import Event
from tms_msg_db.msg import Run as RunRow
from tms_msg_ts.action import ExecuteTask
from tms_msg_ts.msg import RunState

from tms_config.clock import monotonic
from tms_decision.gateway.stops import STOP_PROVEN
from tms_decision.reasons import SoftwareStop
from tms_machine.values import to_parameters
from tms_reason.reason import Reason, Several
from tms_reason.wire import to_line
from tms_ros.node import Ros
from tms_ros.server import Goal
from tms_runtime.log import Logger
from tms_ts.bt import Status, Tree, TreeError
from tms_ts.facts import Facts
from tms_ts.flags import Flags
from tms_ts.journal import Journal
from tms_ts.machine_stops import reported_by
from tms_ts.machines import Machines
from tms_ts.node_report import NodeReport
from tms_ts.reasons import (
    GoalNotEnded,
    HaltedGoalsEnd,
    NotResumed,
    StopRequested,
    TreeOf,
)
from tms_ts.run_checkpoint import RunCheckpoint
from tms_ts.run_states import STATES, entered

TICK_PERIOD = 0.05  # s between ticks when nothing wakes the loop
TICK_LIMIT = 0.4  # s without a tick after which the scheduler ends the permits of its motions
SETTLE_LIMIT = STOP_PROVEN + 7.0  # s for goals to end after a halt

RUNS = Counter("tms_ts_runs_total", "Runs by outcome", ["outcome"])
TICKS = Histogram("tms_ts_tick_seconds", "Duration of a tick", buckets=(0.001, 0.005, 0.01, 0.05, 0.1, 0.25, 0.5))
ALARMS = Counter("tms_ts_alarms_total", "Stops that were not seen, and processes given up during a run")
OVERRUNS = Counter("tms_ts_tick_overruns_total", "Ticks that took longer than the tick period")

TaskGoal = Goal[ExecuteTask.Goal, ExecuteTask.Feedback]


class Run:
    """One run; it exists as long as its ExecuteTask goal."""

    def __init__(
        self, ros: Ros, journal: Journal, log: Logger, goal: TaskGoal, facts: Facts, record: RunCheckpoint,
        changed: Callable[[], None],
    ) -> None:  # fmt: skip
        self.facts = facts
        self._changed = changed  # called when state() has changed
        self.wake = threading.Event()
        self.cancelled = threading.Event()
        self.ended = threading.Event()
        self.over = False  # whether its end is in the history
        self._ros, self._journal, self._log, self._goal = ros, journal, log, goal
        self.record = record
        self.flags: Flags | None = None  # the flags of its tree
        self._resumed = bool(goal.request.resume)
        self.number = 0  # number of the last event
        self._numbering = threading.Lock()  # the executor thread logs events, too
        self._ending: tuple[str, Reason | None] = ("cancelled", None)  # outcome and reason if it is ended from outside
        self.nodes = NodeReport(facts, lambda node, what: self.log_event("node", node, what), changed)
        self._ticked: float | None = None  # when the last tick ended; None while the tree is not ticked

    def cancel(self, outcome: str = "cancelled", reason: Reason | None = None) -> None:
        """Ask the run to stop; returns at once. The reason of the first call counts."""
        if not self.cancelled.is_set():
            self._ending = (outcome, reason)
        self.cancelled.set()
        self.wake.set()

    def stopped(self, machine: str, cause: Reason) -> None:
        """End the run, as a machine was stopped from outside and stays latched until a person re-arms it."""
        wanted = cause.find(SoftwareStop) is not None
        self.cancel("cancelled" if wanted else "failure", StopRequested(machine, cause))

    def alive(self) -> bool:
        """Whether the loop that decides about motions still ticks."""
        ticked = self._ticked
        return ticked is None or monotonic() - ticked < TICK_LIMIT

    # what is reported

    def log_event(self, kind: str, node: str, what: Reason, values: Mapping[str, Any] | None = None) -> None:
        """Write one event into the journal and the log."""
        with self._numbering:
            self.number += 1
            self.record.event(self.number)
            event = Event(
                run_id=self.facts.run_id, number=self.number, stamp=self._ros.now(), kind=kind, node=node,
                text=to_line(what),                values=to_parameters(dict(values or {})),
            )  # fmt: skip
            self._journal.put(event)
        if kind == "alarm":
            ALARMS.inc()
        if kind != "node":
            self._log.info(kind, run=self.facts.run_id, node=node, reason=what)

    def enter(self, state: str, reason: Reason | None = None, ended: bool = False) -> None:
        """Change the run's state."""
        self.facts.state, self.facts.reason = state, reason
        self._journal.put(self._row(ended))
        self.log_event("run", "", entered(state, reason))
        self._changed()

    def _row(self, ended: bool) -> RunRow:
        facts = self.facts
        return RunRow(
            run_id=facts.run_id, task_id=facts.task_id, description=facts.description, state=facts.state,
            reason=to_line(facts.reason), machines=facts.machines, records=facts.records, started_at=facts.started,
            ended_at=self._ros.now() if ended else Time(), values=to_parameters(facts.values),
        )  # fmt: skip

    def state(self) -> RunState:
        """The message for the topic of active runs."""
        facts = self.facts
        return RunState(
            run_id=facts.run_id, task_id=facts.task_id, state=facts.state, machines=facts.machines,
            reason=to_line(facts.reason), started_at=facts.started, leaf=self.nodes.leaf, nodes=self.nodes.states,
        )  # fmt: skip

    def publish_tree(self, tree: Tree) -> None:
        """Publish the shape of the tree once: the console draws states on it, live or from the history."""
        nodes = tree.nodes
        values = {
            "paths": [node.path for node in nodes],
            "names": [node.name for node in nodes],
            "types": [node.registration_name for node in nodes],
            "kinds": [node.kind.name.lower() for node in nodes],
            "ports": [" ".join(f'{port}="{text}"' for port, text in node.assigned().items()) for node in nodes],
        }
        self.log_event("tree", "", TreeOf(len(nodes)), values)

    def _report_to_client(self, tree: Tree, last: bool = False) -> None:
        message = self.nodes.feedback(tree, last)
        if message is not None:
            self._goal.publish(message)

    # the loop

    def execute(self, tree: Tree, machines: Machines) -> str:
        """Tick to the end and stop machines that still move; returns the outcome."""
        tree.observers.append(self.nodes.changed)
        self.enter("running")
        outcome = "failure"
        try:
            outcome = self._tick_to_end(tree, machines)
        except TreeError as error:
            self.nodes.failure = error.reason
            self.log_event("error", error.path or "", error.reason)
        finally:
            outcome = self._settle(tree, machines, outcome)
        return outcome

    def _tick_to_end(self, tree: Tree, machines: Machines) -> str:
        next_tick = self._ticked = monotonic()
        while not self.cancelled.is_set():
            machines.advance()
            begun = monotonic()
            self.nodes.begin_tick()
            status = tree.tick()
            self._ticked = monotonic()
            took = self._ticked - begun
            self.nodes.report_flood()
            self.nodes.report(tree)
            TICKS.observe(took)
            self._report_to_client(tree)
            if status.completed:
                return "success" if status is Status.SUCCESS else "failure"
            if took > TICK_PERIOD:
                OVERRUNS.inc()
            next_tick = min(max(next_tick + TICK_PERIOD, begun), begun + TICK_PERIOD)  # also if it was woken often
            self.wake.wait(max(0.0, next_tick - monotonic()))
            self.wake.clear()
        outcome, self.nodes.failure = self._ending
        return outcome

    def _settle(self, tree: Tree, machines: Machines, outcome: str) -> str:
        """Stop the machines and watch them stand, except after a success without open goals: then no machine moves."""
        self._ticked = None
        moving, receipts = True, []
        try:
            if outcome != "success":
                self.enter("stopping", self.nodes.failure or STATES[outcome])
            tree.halt()
            self.nodes.report(tree)
            self._report_to_client(tree, last=True)
            moving = outcome != "success" or not machines.settled()
            if moving and outcome == "success":  # the tree succeeded in the tick that halted a leaf
                self.nodes.failure = None
                self.enter("stopping", HaltedGoalsEnd())
        finally:  # also if the lines above raise
            if moving:
                # Call the gateways directly, while the cancels still pass subtask and planner: a stop takes the
                # shortest way, and its receipt measures from here.
                receipts = machines.stops.stop_all(self.facts.machines, STATES[outcome])
        if not moving:
            return self._end(outcome, None)
        for receipt in receipts:
            machines.stops.receipt(receipt)
        deadline = monotonic() + SETTLE_LIMIT
        while not machines.settled() and monotonic() < deadline:
            self.wake.wait(TICK_PERIOD)
            self.wake.clear()
        reason = self.nodes.failure
        unseen = [reported_by(receipt) for receipt in receipts if not receipt.confirmed]
        unseen += [GoalNotEnded(name) for name in machines.open_goals()]
        for alarm in unseen:
            self.log_event("alarm", "", alarm)
        if unseen:
            return self._end("stop_unconfirmed", Several((*unseen, *([reason] if reason is not None else []))))
        return self._end(outcome, reason)

    def _end(self, outcome: str, reason: Reason | None) -> str:
        self.over = True
        self.nodes.report_flood(last=True)
        if outcome != "interrupted":
            self.record.over(outcome, to_line(reason))
        self.enter(outcome, reason, ended=True)
        self.close_record(outcome)
        RUNS.labels(outcome).inc()
        return outcome

    def close_record(self, outcome: str) -> None:
        """Keep the checkpoint of an interrupted run, which can be resumed; remove all others."""
        if outcome == "interrupted":
            self.record.interrupted()
            self.record.close()
        else:
            self.record.remove()

    def refuse(self, reason: Reason) -> None:
        """End the run before any machine has moved."""
        self.over = True
        if self._resumed:  # the run stays interrupted
            self.enter("interrupted", NotResumed(reason), ended=True)
            self.record.interrupted()
            self.record.close()
            return
        self.record.over("refused", to_line(reason))
        self.enter("refused", reason, ended=True)
        self.record.remove()
        RUNS.labels("refused").inc()
