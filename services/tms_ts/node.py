"""Process `tms:ts`: runs stored tasks, one after another and several at once."""

import threading
import uuid
from collections import Counter

from builtin_interfaces.msg import Time
from prometheus_client import Gauge
from structlog.contextvars import bind_contextvars
from tms_msg_db.msg import Task
from tms_msg_db.srv import GetTask
from tms_msg_ts.action import ExecuteTask
from tms_msg_ts.msg import RunStates
from tms_msg_ts.srv import AnswerQuestion, CancelRun, CheckTask, ResumePlan

from tms_config.clock import monotonic, utc_now
from tms_machine.reasons import MachineLatched, WaitingFor
from tms_reason import wire
from tms_reason.errors import TaskError, TmsError
from tms_reason.reason import Reason
from tms_reason.wire import refusal, to_line
from tms_ros.goals import Ended, Outcome
from tms_ros.reasons import Internal, NoServer
from tms_runtime.app import App
from tms_runtime.reasons import NotStored
from tms_ts import bt
from tms_ts.flags import Flags
from tms_ts.gateways import Gateways, Holder
from tms_ts.groot.monitor import Monitors
from tms_ts.group_commit import GroupCommit
from tms_ts.hosts import Hosts
from tms_ts.interrupted import Interrupted
from tms_ts.interrupted_run import Header, InterruptedRun
from tms_ts.journal import Journal
from tms_ts.machines import Identity, Machines
from tms_ts.numbers import Numbers, no_disk
from tms_ts.preflight import Findings, at, machines_of, preflight, processes_of, records_of
from tms_ts.questions import Clicks, Questions
from tms_ts.reasons import MachineBusy, NoQuestion, NoRun, Preflight, PreflightMore, Resumed, SchedulerStopped
from tms_ts.replay import Replay
from tms_ts.run import Facts, Run, TaskGoal
from tms_ts.run_checkpoint import Records
from tms_ts.run_states import STATES as RUN_STATES
from tms_ts.shared_records import SharedRecords
from tms_ts.surroundings import PreflightContext, Sensing
from tms_ts.world import World

DB_LIMIT = 5.0  # s
BEGIN_STORED = 5.0  # s for what is known of a run to be on the disk before it moves anything
END_STORED = 5.0  # s for its end, before it is reported without
DISK_END = 0.2  # s for the last entries when the process ends
SERVERS_LIMIT = 15.0  # s for the subtasks' servers to be there after their start ...
SERVER_START = 3.0  # s, ... and this for each of them: many starting at once share the cores
STATES = ("preparing", "running", "stopping")
ACTIVE = Gauge("tms_ts_active_runs", "Active runs by state", ["state"])
NODES = Gauge("tms_ts_tree_nodes", "Nodes of the active runs' trees by status", ["status"])
RUNS_LONGEST = 1.0  # s between messages on the topic of active runs ...
RUNS_SHORTEST = 0.05  # s ... and when something changes all the time
MEASURE = 1.0  # s between looks at the runs for metrics


def start(app: App) -> None:
    """Serve /tms/execute_task and what belongs to it."""
    scheduler = Scheduler(app)
    app.ros.serve(ExecuteTask, "/tms/execute_task", scheduler.execute)
    app.ros.offer(CancelRun, "/tms/cancel_run", scheduler.cancel)
    app.ros.offer_slow(CheckTask, "/tms/check_task", scheduler.check)
    app.ros.offer_slow(ResumePlan, "/tms/resume_plan", scheduler.interrupted.plan)
    app.ros.offer_slow(CancelRun, "/tms/abandon_run", scheduler.interrupted.abandon)
    app.ros.offer(AnswerQuestion, "/tms/answer", scheduler.answer)
    app.ros.every(MEASURE, scheduler.measure)
    app.on_stop(scheduler.close)
    app.ready_when(scheduler.unready)


class Scheduler:
    """All active runs."""

    def __init__(self, app: App) -> None:
        self._app, self._ros = app, app.ros
        self._hosts = Hosts(app.ros)
        self._disk = GroupCommit(app.log)
        self._journal = Journal(app.ros, app.log, self._disk, app.site.state)
        self._records = Records(app.site.state, self._disk)
        self._records.check()
        self.interrupted = Interrupted(app, self._journal, self._records)
        self._gateways = Gateways(app, self.interrupted.receipt)
        self._monitors = Monitors(app.log, app.site.file.groot.bind, app.site.file.ports.groot)
        self._numbers = Numbers(app.site.state, self._disk)
        self._shared = SharedRecords(app.ros)
        self._sensing = Sensing(app)
        self._runs: dict[str, Run] = {}
        self._holders: dict[str, str] = {}  # machine -> run that moves it
        self._lock = threading.Lock()  # over the two above; held for moments only
        self._changed, self._closing = threading.Event(), threading.Event()
        self._questions = Questions(app.ros, self._changed.set)
        self._publisher = app.ros.publisher(RunStates, "/tms/runs", depth=1, latched=True)
        threading.Thread(target=self._report, name="runs", daemon=True).start()

    def unready(self) -> Reason | None:
        """The scheduler works only with the database."""
        return None if self._ros.has_service(GetTask, "/tms/db/get_task") else WaitingFor("tms:db")

    def states(self) -> RunStates:
        """Active runs and open questions."""
        with self._lock:
            runs = [run.state() for run in self._runs.values()]
        return RunStates(runs=runs, questions=self._questions.messages())

    def _report(self) -> None:
        """Publish what changed at once, but not more often than anybody can see."""
        while not self._closing.wait(RUNS_SHORTEST):
            self._changed.wait(RUNS_LONGEST - RUNS_SHORTEST)
            self._changed.clear()
            if not self._closing.is_set():
                self._publisher.publish(self.states())

    def answer(self, request: AnswerQuestion.Request, response: AnswerQuestion.Response) -> AnswerQuestion.Response:
        """Take an operator's answer to a WaitForClick node."""
        if not self._questions.answer(request.id, request.yes, request.by or "an operator"):
            gone = NoQuestion(request.id)
            response.error_code, response.error_msg = gone.code, to_line(gone)
        return response

    def measure(self) -> None:
        """The metrics of the active runs, and whether their history is in danger."""
        with self._lock:
            runs = list(self._runs.values())
        for alarm in self._journal.alarms():
            self._app.log.error("alarm", reason=alarm)
            for run in runs:
                run.log_event("alarm", "", alarm)
        for state in STATES:
            ACTIVE.labels(state).set(sum(run.facts.state == state for run in runs))
        counted = Counter(state for run in runs for state in run.states)
        for status in bt.Status:
            NODES.labels(status.name.lower()).set(counted[status])

    def close(self) -> None:
        """The process ends: runs stop their machines; the runtime waits a moment for their threads."""
        with self._lock:
            runs = list(self._runs.values())
        for run in runs:
            run.cancel("interrupted", SchedulerStopped())
        deadline = monotonic() + 1.0
        for run in runs:
            run.ended.wait(max(0.0, deadline - monotonic()))
        self._closing.set()
        self._disk.close(DISK_END)
        self._journal.close()

    def cancel(self, request: CancelRun.Request, response: CancelRun.Response) -> CancelRun.Response:
        """Ask a run to stop; its end comes with its result."""
        with self._lock:
            run = self._runs.get(request.run_id)
            active = tuple(self._runs)
        if run is None:
            none = NoRun(request.run_id, active)
            response.error_code, response.error_msg = none.code, to_line(none)
        else:
            run.cancel()
        return response

    def check(self, request: CheckTask.Request, response: CheckTask.Response) -> CheckTask.Response:
        """Preflight of a stored task or of XML, without running."""
        try:
            xml = request.xml if request.task_id == 0 else self._task(request.task_id).task_sequence
            report = bt.check(xml)
            if report.ok:
                found = self._preflight(bt.load(xml, world=None), present=True)
                response.errors = list(map(to_line, found.errors))
                response.warnings = list(map(to_line, found.warnings))
            else:
                response.errors = [to_line(error.reason) for error in report.errors]
                response.warnings = [to_line(at(line, what)) for line, what in report.warnings]
        except TmsError as error:
            response.error_code, response.error_msg = error.code, to_line(error.reason)
        return response

    # a run

    def execute(self, goal: TaskGoal) -> Ended[ExecuteTask.Result]:
        """One ExecuteTask goal, from the database to the machines' stand-still; its end is stored, then told."""
        how, result = self._execute_any(goal)
        if not self._disk.wait(END_STORED):
            end = wire.of(result.error_msg) or RUN_STATES[result.outcome]
            result.error_msg = to_line(NotStored(end))
        return how, result

    def _execute_any(self, goal: TaskGoal) -> Ended[ExecuteTask.Result]:
        if not goal.request.resume:
            return self._run(goal, None)
        try:
            past, header = self.interrupted.begin(goal.request.resume)
        except TaskError as error:
            return _refused(goal.request.resume, error)
        try:
            return self._run(goal, past)
        finally:
            self.interrupted.over(header.run_id)

    def _run(self, goal: TaskGoal, past: InterruptedRun | None) -> Ended[ExecuteTask.Result]:
        try:
            facts = self._facts(goal, past)
        except TaskError as error:
            return _refused(goal.request.resume, error)
        bind_contextvars(run=facts.run_id)
        run = Run(
            self._ros, self._journal, self._app.log, goal, facts, self._records.open(facts.run_id), self._changed.set
        )
        run.number = past.last_event if past is not None else 0
        goal.publish(ExecuteTask.Feedback(run_id=facts.run_id, state=facts.state))  # the client can ask for it now
        goal.on_cancel = run.cancel
        if goal.cancelled.is_set():
            run.cancel()
        with self._lock:
            self._runs[facts.run_id] = run
        try:
            return self._execute(run, goal, past)
        except TmsError as error:
            run.refuse(error.reason)
            return _refused(facts.run_id, error)
        finally:
            if not run.over:  # a bug; what failed is in the log
                run.refuse(Internal(self._app.process.full))
            if run.flags is not None:
                run.flags.close()
            self._gateways.drop(self._held_by(facts.run_id))
            with self._lock:
                del self._runs[facts.run_id]
                for machine in [name for name, holder in self._holders.items() if holder == facts.run_id]:
                    del self._holders[machine]
            self._changed.set()
            run.ended.set()

    def _facts(self, goal: TaskGoal, past: InterruptedRun | None) -> Facts:
        number = self._numbers.next()
        if past is not None and past.header is not None:
            old = past.header
            started = Time(sec=old.started[0], nanosec=old.started[1])
            return Facts(old.run_id, number, old.task_id, old.description, old.machines, started)
        stamp = utc_now().strftime("%Y%m%d-%H%M%S")
        run_id = f"{stamp}-{uuid.uuid4().hex[:4]}"
        return Facts(run_id, number, goal.request.task_id, "", [], self._ros.now())

    def _execute(self, run: Run, goal: TaskGoal, past: InterruptedRun | None) -> Ended[ExecuteTask.Result]:
        facts = run.facts
        goal.publish(ExecuteTask.Feedback(run_id=facts.run_id, state=facts.state))  # so that it can be cancelled
        if past is not None and past.header is not None:
            xml = past.header.xml
        else:
            task = self._task(facts.task_id)
            facts.description, xml = task.description, task.task_sequence
        replay = Replay(past.ended if past is not None else [])
        identity = Identity(facts.number, self._app.site.file.on_loss.retries, run.record, replay)
        machines = Machines(self._ros, self._hosts, self._gateways, run.wake.set, run.log_event, identity)
        run.flags = Flags(self._ros, self._shared, run.wake.set, facts.run_id)
        clicks = Clicks(self._questions, facts.run_id, run.wake.set, run.log_event)
        world = World(machines, run.flags, clicks)
        tree = bt.load(xml, world=world)
        replay.beside = tree.beside
        facts.machines, facts.records = machines_of(tree), records_of(tree)
        facts.writes = {(value.record, value.field) for value in tree.shared_values() if value.writes}
        started = (facts.started.sec, facts.started.nanosec)
        known = (facts.run_id, facts.number, facts.task_id, facts.description, facts.machines, xml, started)
        run.record.begin(Header(*known, facts.records))
        run.enter("preparing", Resumed() if past is not None else None)
        run.publish_tree(tree)
        self._refuse_errors(run, self._preflight(tree), goal.request.ignore_warnings)
        self._hold(run)
        self._prepare(run, processes_of(tree, self._app.site), machines)
        if not self._disk.wait(BEGIN_STORED):
            raise no_disk(self._disk)
        # Not before: while many processes start on a busy PC a permit may lapse, though nothing moves yet.
        holder = Holder(facts.number, started, run.stopped, machines.receipt, run.alive)
        self._gateways.hold(facts.machines, facts.run_id, holder)
        if not run.cancelled.is_set():
            self._refuse_latched(facts.machines)  # stopped meanwhile
        with self._monitors.watch(facts.run_id, tree):
            outcome = run.execute(tree, machines)
        return _ended(facts, outcome)

    def _refuse_errors(self, run: Run, found: Findings, ignore_warnings: bool) -> None:
        for warning in found.warnings:
            run.log_event("warning", "", warning)
        if found.errors:
            first, more = found.errors[0], len(found.errors) - 1
            raise TaskError(PreflightMore(first, more) if more else Preflight(first), Preflight.code)

    def _hold(self, run: Run) -> None:
        """One machine in one run at a time."""
        with self._lock:
            for machine in run.facts.machines:
                holder = self._holders.get(machine)
                if holder is not None:
                    raise TaskError(MachineBusy(machine, holder))
            self._refuse_latched(run.facts.machines)
            self._holders.update(dict.fromkeys(run.facts.machines, run.facts.run_id))

    def _refuse_latched(self, machines: list[str]) -> None:
        for machine in machines:
            found = self._gateways.held_back(machine)
            if found is not None:
                raise TaskError(found, "NOT_ARMED" if isinstance(found, MachineLatched) else found.code)

    def _held_by(self, run_id: str) -> list[str]:
        with self._lock:
            return [machine for machine, holder in self._holders.items() if holder == run_id]

    def _prepare(self, run: Run, processes: list[str], machines: Machines) -> None:
        """Start the subtasks that the tree names and wait until their servers are there."""
        self._hosts.wait_known(3.0)
        problem = self._hosts.start(processes, run.cancelled.is_set)
        if problem is not None and not run.cancelled.is_set():
            raise TaskError(problem, "NO_PROCESS")
        waiting = {name: machines.peer(*name.split(":", 1)) for name in processes}
        limit = SERVERS_LIMIT + SERVER_START * len(waiting)
        deadline = monotonic() + limit
        while waiting and not run.cancelled.is_set():
            waiting = {name: peer for name, peer in waiting.items() if not peer.ready()}
            if waiting and monotonic() > deadline:
                name = next(iter(waiting))
                raise TaskError(NoServer(name, waiting[name].name, limit))
            run.wake.wait(0.02)

    # the database

    def _task(self, task_id: int) -> Task:
        answer = self._ros.call(GetTask, "/tms/db/get_task", GetTask.Request(task_id=task_id), DB_LIMIT)
        if answer.error_code:
            raise TaskError(refusal(answer.error_code, answer.error_msg), answer.error_code)
        return answer.task

    def _preflight(self, tree: bt.Tree, present: bool = False) -> Findings:
        """`present`: also say what keeps the machines from moving now; a run is refused for that later."""
        problem = self._problem if present else _no_problem
        return preflight(tree, self._app.site, PreflightContext(self._app, self._sensing, problem, self._written))

    def _problem(self, machine: str) -> Reason | None:
        with self._lock:
            holder = self._holders.get(machine)
        return MachineBusy(machine, holder) if holder is not None else self._gateways.obstacle(machine)

    def _written(self, record: str, field: str) -> bool:
        """Whether an active run writes a shared value."""
        with self._lock:
            return any((record, field) in run.facts.writes for run in self._runs.values())


def _no_problem(_machine: str) -> None:
    return None


def _ended(facts: Facts, outcome: str) -> Ended[ExecuteTask.Result]:
    codes = {
        "success": "",
        "failure": "FAILED",
        "cancelled": "CANCELLED",
        "stop_unconfirmed": "STOP_UNCONFIRMED",
        "interrupted": "INTERRUPTED",
    }
    line = to_line(facts.reason)
    result = ExecuteTask.Result(run_id=facts.run_id, outcome=outcome, error_code=codes[outcome], error_msg=line)
    how = {"success": Outcome.SUCCEEDED, "cancelled": Outcome.CANCELED}
    return how.get(outcome, Outcome.ABORTED), result


def _refused(run_id: str, error: TmsError) -> Ended[ExecuteTask.Result]:
    line = to_line(error.reason)
    result = ExecuteTask.Result(run_id=run_id, outcome="refused", error_code=error.code, error_msg=line)
    return Outcome.ABORTED, result
