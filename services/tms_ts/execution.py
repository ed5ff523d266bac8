"""One ExecuteTask goal: from the stored task to the machines' stand-still."""

import threading
import uuid
from dataclasses import dataclass

from builtin_interfaces.msg import Time
from structlog.contextvars import bind_contextvars
from tms_msg_ts.action import ExecuteTask

from tms_config.clock import monotonic, utc_now
from tms_decision.leaf.replay import Replay
from tms_reason import wire
from tms_reason.errors import TaskError, TmsError
from tms_reason.reason import Reason
from tms_reason.wire import to_line
from tms_ros.goals import Ended, Outcome
from tms_ros.reasons import Internal, NoServer
from tms_runtime.app import App
from tms_runtime.reasons import NotStored
from tms_ts import bt
from tms_ts.active_runs import ActiveRuns
from tms_ts.facts import Facts
from tms_ts.flags import Flags
from tms_ts.gateways import Gateways, Holder
from tms_ts.groot.monitor import Monitors
from tms_ts.group_commit import GroupCommit
from tms_ts.hosts import Hosts
from tms_ts.interrupted import Interrupted
from tms_ts.interrupted_run import Header, InterruptedRun
from tms_ts.journal import Journal
from tms_ts.leases import Leases
from tms_ts.machines import Identity, LeafPeer, Machines
from tms_ts.numbers import Numbers, no_disk
from tms_ts.other_runs import orders_told, writes_told
from tms_ts.place_check import orders_of
from tms_ts.place_requests import PlaceRequests, RunPlaces
from tms_ts.preflight import Findings, machines_of, processes_of, records_of
from tms_ts.questions import Clicks
from tms_ts.reasons import Preflight, PreflightMore, Resumed
from tms_ts.run import Run, TaskGoal
from tms_ts.run_checkpoint import Records
from tms_ts.run_states import STATES
from tms_ts.runs_publisher import RunsPublisher
from tms_ts.shared_records import SharedRecords
from tms_ts.task_check import TaskCheck, not_free
from tms_ts.world import World

BEGIN_STORED = 5.0  # s for the known facts of a run to be on the disk before it moves a machine
END_STORED = 5.0  # s for its end to be on the disk, before it is reported with a note that it is not
SERVERS_LIMIT = 15.0  # s for the subtasks' servers to be there after their start ...
SERVER_START = 3.0  # s, ... and this for each of them: many starting at once share the cores
# Times as long as a client took to be made: all processes of the site hear of its eight ends. Made in one go, those
# of two runs kept goals at work from their beats on full processors: their machines were stopped.
REST = 2.0
CODES = {
    "success": "",
    "failure": "FAILED",
    "cancelled": "CANCELLED",
    "stop_unconfirmed": "STOP_UNCONFIRMED",
    "interrupted": "INTERRUPTED",
}
HOW = {"success": Outcome.SUCCEEDED, "cancelled": Outcome.CANCELED}


@dataclass(frozen=True)
class Parts:
    """What the runs of a scheduler share."""

    app: App
    disk: GroupCommit
    journal: Journal
    records: Records
    numbers: Numbers
    shared: SharedRecords
    hosts: Hosts
    gateways: Gateways
    monitors: Monitors
    interrupted: Interrupted
    runs: ActiveRuns
    publisher: RunsPublisher
    check: TaskCheck
    places: PlaceRequests
    leases: Leases


class Execution:
    """Serves ExecuteTask: each goal is a run, in a thread of its own."""

    def __init__(self, parts: Parts) -> None:
        self._parts, self._ros = parts, parts.app.ros
        self._making = threading.Lock()  # clients, of one run at a time

    def execute(self, goal: TaskGoal) -> Ended[ExecuteTask.Result]:
        """Run a task from the database to the machines' stand-still; the end is stored, then reported."""
        how, result = self._execute_any(goal)
        if not self._parts.disk.wait(END_STORED):
            end = wire.of(result.error_msg) or STATES[result.outcome]
            result.error_msg = to_line(NotStored(end))
        return how, result

    def _execute_any(self, goal: TaskGoal) -> Ended[ExecuteTask.Result]:
        if not goal.request.resume:
            return self._run_own(goal)
        interrupted = self._parts.interrupted
        try:
            past, header = interrupted.begin(goal.request.resume)
        except TaskError as error:
            return _refused(goal.request.resume, error)
        try:
            return self._run(goal, past)
        finally:
            interrupted.over(header.run_id)

    def _run_own(self, goal: TaskGoal) -> Ended[ExecuteTask.Result]:
        parts = self._parts
        if parts.leases.several:
            try:
                text = parts.check.task(goal.request.task_id).task_sequence
                tree = bt.load(text, world=None, templates=parts.check.template)
                parts.leases.refuse_other(machines_of(tree))
            except TmsError as error:
                return _refused("", error)
        return self._run(goal, None)

    def _run(self, goal: TaskGoal, past: InterruptedRun | None) -> Ended[ExecuteTask.Result]:
        parts = self._parts
        try:
            facts = self._facts(goal, past)
        except TmsError as error:
            return _refused(goal.request.resume, error)
        bind_contextvars(run=facts.run_id)
        record = parts.records.open(facts.run_id)
        run = Run(self._ros, parts.journal, parts.app.log, goal, facts, record, parts.publisher.changed)
        run.number = past.last_event if past is not None else 0
        goal.publish(ExecuteTask.Feedback(run_id=facts.run_id, state=facts.state))  # now the client knows the run
        goal.on_cancel = run.cancel
        if goal.cancelled.is_set():
            run.cancel()
        parts.runs.add(run)
        try:
            return self._execute(run, goal, past)
        except TmsError as error:
            run.refuse(error.reason)
            return _refused(facts.run_id, error)
        finally:
            self._leave(run)

    def _leave(self, run: Run) -> None:
        parts = self._parts
        if not run.over:  # a bug; the log has the error
            run.refuse(Internal(parts.app.process.full))
        if run.flags is not None:
            run.flags.close()
        if run.places is not None:
            run.places.close(run.facts.machines)
        parts.runs.remove(run)
        parts.leases.give_back(run.facts)
        parts.publisher.changed()
        run.ended.set()

    def _facts(self, goal: TaskGoal, past: InterruptedRun | None) -> Facts:
        number = self._parts.numbers.next(self._parts.leases.last())
        if past is not None and past.header is not None:
            old = past.header
            started = Time(sec=old.started[0], nanosec=old.started[1])
            known = (old.run_id, number, old.task_id, old.description, old.machines, started)
            return Facts(*known, values=dict(old.values))
        stamp = utc_now().strftime("%Y%m%d-%H%M%S")
        run_id = f"{stamp}-{uuid.uuid4().hex[:4]}{self._parts.leases.scheduler.suffix}"
        return Facts(run_id, number, goal.request.task_id, "", [], self._ros.now())

    def _execute(self, run: Run, goal: TaskGoal, past: InterruptedRun | None) -> Ended[ExecuteTask.Result]:
        parts, facts = self._parts, run.facts
        goal.publish(ExecuteTask.Feedback(run_id=facts.run_id, state=facts.state))  # so that it can be cancelled
        xml, templates = self._xml(facts, past)
        replay = Replay(past.ended if past is not None else [])
        identity = Identity(facts.number, parts.app.site.file.on_loss.retries, run.record, replay)
        site, gateways = parts.app.site, parts.gateways
        machines = Machines(self._ros, site, parts.hosts, gateways, run.wake.set, run.log_event, identity)
        run.flags = Flags(self._ros, parts.shared, run.wake.set, facts.run_id)
        clicks = Clicks(parts.publisher.questions, facts.run_id, run.wake.set, run.log_event)
        run.places = RunPlaces(parts.places, facts.run_id, run.wake.set)
        tree = bt.load(xml, world=World(machines, run.flags, clicks, run.places), templates=templates)
        replay.beside = tree.beside
        self._begin(run, tree, xml, resumed=past is not None)
        parts.check.refuse_latched(facts.machines)
        self._prepare(run, processes_of(tree, site), machines)
        if not parts.disk.wait(BEGIN_STORED):
            raise no_disk(parts.disk)
        with parts.monitors.watch(facts.run_id, tree):
            run.execute(tree, machines, _RunPermits(parts, run, machines))
        return _ended(facts) if run.refused is None else _refused(facts.run_id, not_free(run.refused))

    def _xml(self, facts: Facts, past: InterruptedRun | None) -> tuple[str, bt.Templates]:
        """The text of the stored task and the stored templates; of a resumed run, as they were at its start."""
        if past is not None and past.header is not None:
            return past.header.xml, past.header.templates.get
        task = self._parts.check.task(facts.task_id)
        facts.description = task.description
        return task.task_sequence, self._parts.check.template

    def _begin(self, run: Run, tree: bt.Tree, xml: str, resumed: bool) -> None:
        """Enter the run into the history, check it, and take its machines."""
        facts = run.facts
        facts.machines, facts.records = machines_of(tree), records_of(tree)
        facts.orders = orders_told(orders_of(tree))
        facts.writes = writes_told((value.record, value.field) for value in tree.shared_values() if value.writes)
        started = (facts.started.sec, facts.started.nanosec)
        known = (facts.run_id, facts.number, facts.task_id, facts.description, facts.machines, xml, started)
        run.record.begin(Header(*known, facts.records, facts.values, tree.templates))
        run.enter("preparing", Resumed() if resumed else None)
        run.publish_tree(tree)
        _refuse_errors(run, self._parts.check.before_run(tree))
        self._parts.runs.hold(run)
        self._parts.leases.take(facts)

    def _prepare(self, run: Run, processes: list[str], machines: Machines) -> None:
        """Start the subtasks that the tree names and wait until their servers are there."""
        hosts = self._parts.hosts
        hosts.wait_known(3.0)
        problem = hosts.start(processes, run.cancelled.is_set)
        if problem is not None and not run.cancelled.is_set():
            raise TaskError(problem, "NO_PROCESS")
        waiting = self._clients(run, processes, machines)
        limit = SERVERS_LIMIT + SERVER_START * len(waiting)
        deadline = monotonic() + limit
        while not run.cancelled.is_set() and (waiting := {n: peer for n, peer in waiting.items() if not peer.ready()}):
            if monotonic() > deadline:
                name = next(iter(waiting))
                raise TaskError(NoServer(name, waiting[name].name, limit))
            run.cancelled.wait(0.02)

    def _clients(self, run: Run, processes: list[str], machines: Machines) -> dict[str, LeafPeer]:
        """A client for each subtask, with a rest after each."""
        clients: dict[str, LeafPeer] = {}
        for name in processes:
            with self._making:
                begun = monotonic()
                clients[name] = machines.peer(*name.split(":", 1))
                run.cancelled.wait(REST * (monotonic() - begun))
        return clients


class _RunPermits:
    """The permits of one run. Held late: while many processes start on a busy PC, a permit may lapse."""

    def __init__(self, parts: Parts, run: Run, machines: Machines) -> None:
        self._parts, self._run, self._machines = parts, run, machines

    def hold(self) -> Reason | None:
        facts, parts, run = self._run.facts, self._parts, self._run
        started = (facts.started.sec, facts.started.nanosec)
        holder = Holder(facts.number, started, run.stopped, self._machines.stops.receipt, run.alive)
        parts.gateways.hold(facts.machines, facts.run_id, holder)
        back = map(parts.gateways.held_back, facts.machines)  # a machine may have been stopped meanwhile
        return next(filter(None, back), None)

    def drop(self) -> None:
        self._parts.gateways.drop(self._run.facts.machines)


def _refuse_errors(run: Run, found: Findings) -> None:
    for warning in found.warnings:
        run.log_event("warning", "", warning)
    if found.errors:
        first, more = found.errors[0], len(found.errors) - 1
        raise TaskError(PreflightMore(first, more) if more else Preflight(first), Preflight.code)


def _ended(facts: Facts) -> Ended[ExecuteTask.Result]:
    line, outcome = to_line(facts.reason), facts.state
    result = ExecuteTask.Result(run_id=facts.run_id, outcome=outcome, error_code=CODES[outcome], error_msg=line)
    return HOW.get(outcome, Outcome.ABORTED), result


def _refused(run_id: str, error: TmsError) -> Ended[ExecuteTask.Result]:
    line = to_line(error.reason)
    result = ExecuteTask.Result(run_id=run_id, outcome="refused", error_code=error.code, error_msg=line)
    return Outcome.ABORTED, result
