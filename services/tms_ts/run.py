"""One run of a task: ticks its tree, records every change, and ends with every machine seen to stand."""

import threading
from collections import deque
from collections.abc import Callable, Mapping
from typing import Any, Protocol

from builtin_interfaces.msg import Time
from prometheus_client import Counter, Histogram
from tms_msg_db.msg import Event
from tms_msg_db.msg import Run as RunRow
from tms_msg_ts.action import ExecuteTask
from tms_msg_ts.msg import RunState

from tms_config.clock import monotonic
from tms_decision.run import effects as f
from tms_decision.run import events as e
from tms_decision.run.step import Phase, step
from tms_decision.run.step import Run as Decisions
from tms_machine.values import to_parameters
from tms_reason.reason import Reason
from tms_reason.wire import to_line
from tms_ros.node import Ros
from tms_ros.server import Goal
from tms_runtime.log import Logger
from tms_ts.bt import Status, Tree, TreeError
from tms_ts.bt.blackboard import Blackboard
from tms_ts.facts import Facts
from tms_ts.flags import Flags
from tms_ts.journal import Journal
from tms_ts.machine_stops import reported_by
from tms_ts.machines import Machines
from tms_ts.node_report import NodeReport
from tms_ts.place_requests import RunPlaces
from tms_ts.reasons import TreeOf
from tms_ts.run_checkpoint import RunCheckpoint
from tms_ts.run_states import STATES, entered

TICK_PERIOD = 0.05  # s between ticks when nothing wakes the loop

RUNS = Counter("tms_ts_runs_total", "Runs by outcome", ["outcome"])
TICKS = Histogram("tms_ts_tick_seconds", "Duration of a tick", buckets=(0.001, 0.005, 0.01, 0.05, 0.1, 0.25, 0.5))
ALARMS = Counter("tms_ts_alarms_total", "Stops that were not seen, and processes given up during a run")
OVERRUNS = Counter("tms_ts_tick_overruns_total", "Ticks that took longer than the tick period")

TaskGoal = Goal[ExecuteTask.Goal, ExecuteTask.Feedback]


class Permits(Protocol):
    """The permits of the run's machines."""

    def hold(self) -> Reason | None: ...  # returns why one of the machines may not move now

    def drop(self) -> None: ...


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
        self._ros, self._journal, self._log, self._goal = ros, journal, log, goal
        self.record = record
        self.flags: Flags | None = None  # the flags of its tree
        self.places: RunPlaces | None = None  # and the shared places
        self.boards: Mapping[str, Blackboard] = {}  # by the paths of its nodes
        self.number = 0  # number of the last event
        self._numbering = threading.Lock()  # the executor thread logs events, too
        self.nodes = NodeReport(facts, lambda node, what: self.log_event("node", node, what), changed)
        self._core = Decisions(resumed=bool(goal.request.resume))  # changed by the run's own thread
        self._coming: deque[e.Event] = deque()  # that other threads have told
        self._doers: dict[type[f.Effect], Callable[[Any], None]] = {
            f.Hold: self._hold, f.Drop: lambda _: self._permits.drop(), f.Enter: self._enter,
            f.Halt: self._halt, f.StopMachines: self._stop_machines,
            f.Alarm: lambda effect: self.log_event("alarm", "", effect.what),
            f.KeepEnd: lambda effect: record.over(effect.outcome, to_line(effect.why)),
            f.KeepInterrupted: self._close, f.Forget: lambda _: record.remove(),
        }  # fmt: skip

    def cancel(self, outcome: str = "cancelled", reason: Reason | None = None) -> None:
        """Ask the run to stop; returns at once. The reason of the first call counts."""
        self._end(e.EndAsked(outcome, reason))

    def stopped(self, machine: str, cause: Reason) -> None:
        """End the run, as a machine was stopped from outside and stays latched until a person re-arms it."""
        self._end(e.StoppedOutside(machine, cause))

    def _end(self, event: e.Event) -> None:
        if not self.cancelled.is_set():
            self._coming.append(event)
        self.cancelled.set()
        self.wake.set()

    def alive(self) -> bool:
        """Whether the loop that decides about motions still ticks."""
        return self._core.works(monotonic())

    @property
    def refused(self) -> Reason | None:
        """Why it was refused, before any machine has moved."""
        return self._core.refused

    @property
    def over(self) -> bool:
        """Whether its end is in the history."""
        return self._core.phase is Phase.OVER

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
            orders=facts.orders, writes=facts.writes,
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
        if any(node.template for node in nodes):
            values["templates"] = [node.template for node in nodes]
        self.boards = {node.path: node.blackboard for node in nodes}
        self.log_event("tree", "", TreeOf(len(nodes)), values)

    def _report_to_client(self, tree: Tree, last: bool = False) -> None:
        message = self.nodes.feedback(tree, last)
        if message is not None:
            self._goal.publish(message)

    # the loop

    def execute(self, tree: Tree, machines: Machines, permits: Permits) -> None:
        """Tick to the end and stop machines that still move."""
        self._tree, self._machines, self._permits = tree, machines, permits
        tree.observers.append(self.nodes.changed)
        self._step(e.Prepared())
        next_tick = monotonic()
        while self._core.phase is Phase.RUNNING:
            next_tick = self._tick(next_tick)
            self._take()
        while self._core.phase is not Phase.OVER:
            self.wake.wait(TICK_PERIOD)
            self.wake.clear()
            self._look()

    def _tick(self, next_tick: float) -> float:
        """Tick the tree once and wait for the next tick; returns when that is due."""
        ended = e.Ticked("failure")  # if this raises
        begun = monotonic()
        try:
            ended = self._tick_once()
        except TreeError as error:
            self.nodes.failure = error.reason
            self.log_event("error", error.path or "", error.reason)
            ended = e.Ticked("failure", error.reason)
        finally:
            self._step(ended)
        if self._core.phase is not Phase.RUNNING:
            return next_tick
        next_tick = min(max(next_tick + TICK_PERIOD, begun), begun + TICK_PERIOD)  # also if it was woken often
        self.wake.wait(max(0.0, next_tick - monotonic()))
        self.wake.clear()
        return next_tick

    def _tick_once(self) -> e.Ticked:
        self._machines.advance()
        begun = monotonic()
        self.nodes.begin_tick()
        status = self._tree.tick()
        took = monotonic() - begun
        self.nodes.report_flood()
        self.nodes.report(self._tree)
        TICKS.observe(took)
        self._report_to_client(self._tree)
        if took > TICK_PERIOD and not status.completed:
            OVERRUNS.inc()
        if not status.completed:
            return e.Ticked()
        return e.Ticked("success" if status is Status.SUCCESS else "failure", self.nodes.failure)

    def _look(self) -> None:
        self._step(e.Looked(not self._machines.settled(), self._machines.open_goals()))

    # decisions

    def _take(self) -> None:
        """Decide about what other threads have told."""
        while self._coming:
            self._step(self._coming.popleft())

    def _step(self, event: e.Event) -> None:
        for effect in step(self._core, event, monotonic()):
            self._doers[type(effect)](effect)

    # effects

    def _hold(self, _: f.Hold) -> None:
        self._take()
        self._step(e.Held(self._permits.hold()))

    def _halt(self, _: f.Halt) -> None:
        moves = True
        try:
            self._tree.halt()
            self.nodes.report(self._tree)
            self._report_to_client(self._tree, last=True)
            moves = not self._machines.settled()
        finally:  # the machines are stopped also if the lines above raise
            self._step(e.Halted(moves))

    def _stop_machines(self, effect: f.StopMachines) -> None:
        """Call the gateways directly, while the cancels still pass subtask and planner.

        A stop takes the shortest way, and its receipt measures from here.
        """
        stops = self._machines.stops
        receipts = stops.stop_all(self.facts.machines, STATES[effect.outcome])
        for receipt in receipts:
            stops.receipt(receipt)
        self._step(e.Stood([reported_by(receipt) for receipt in receipts if not receipt.confirmed]))
        self._look()

    def _enter(self, effect: f.Enter) -> None:
        why = effect.why
        if effect.state == "stopping" and why is None:
            why = STATES[self._core.outcome]
        if effect.ended:
            self.nodes.report_flood(last=True)
            RUNS.labels(effect.state).inc()
        self.enter(effect.state, why, effect.ended)

    def _close(self, _: f.KeepInterrupted) -> None:
        """Keep the checkpoint of an interrupted run, which can be resumed."""
        self.record.interrupted()
        self.record.close()

    def refuse(self, reason: Reason) -> None:
        """End the run before any machine has moved, or by a bug."""
        self._step(e.Refused(reason))
