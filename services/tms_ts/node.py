"""Process `tms:ts`: runs stored tasks, one after another and several at once."""

from std_msgs.msg import String
from tms_msg_db.srv import GetTask
from tms_msg_ts.action import ExecuteTask
from tms_msg_ts.srv import AnswerQuestion, CancelRun, CheckTask, ResumePlan

from tms_config.clock import monotonic
from tms_machine.reasons import WaitingFor
from tms_reason.reason import Reason
from tms_reason.wire import to_line
from tms_runtime.app import App
from tms_ts.active_runs import ActiveRuns
from tms_ts.blackboards import Blackboards
from tms_ts.bt import palette
from tms_ts.execution import Execution, Parts
from tms_ts.gateways import Gateways
from tms_ts.groot.monitor import Monitors
from tms_ts.group_commit import GroupCommit
from tms_ts.hosts import Hosts
from tms_ts.interrupted import Interrupted
from tms_ts.journal import Journal
from tms_ts.leases import Leases
from tms_ts.numbers import Numbers
from tms_ts.other_runs import OtherRuns
from tms_ts.permissions import Permissions
from tms_ts.place_requests import PlaceRequests
from tms_ts.reasons import NoQuestion, NoRun, SchedulerStopped
from tms_ts.run_checkpoint import Records
from tms_ts.runs_publisher import RunsPublisher
from tms_ts.shared_records import SharedRecords
from tms_ts.task_check import TaskCheck

DISK_END = 0.2  # s for the last entries when the process ends
MEASURE = 1.0  # s between updates of the metrics of runs


def start(app: App) -> None:
    """Serve execute_task and the services for runs, and tell which nodes trees can have."""
    parts = _parts(app)
    scheduler, named = Scheduler(parts), parts.leases.scheduler.named
    app.ros.serve(ExecuteTask, named("execute_task"), Execution(parts).execute)
    app.ros.offer(CancelRun, named("cancel_run"), scheduler.cancel)
    app.ros.offer_slow(CheckTask, named("check_task"), parts.check.check)
    app.ros.offer_slow(ResumePlan, named("resume_plan"), parts.interrupted.plan)
    app.ros.offer_slow(CancelRun, named("abandon_run"), parts.interrupted.abandon)
    app.ros.offer(AnswerQuestion, named("answer"), scheduler.answer)
    app.ros.publisher(String, named("palette"), depth=1, latched=True).publish(String(data=palette(builtin=True)))
    Permissions(parts.runs, parts.publisher.questions).serve(app, parts.leases.scheduler.machines)
    Blackboards(parts.runs).serve(app, named("blackboard"))
    app.ros.every(MEASURE, scheduler.measure)
    app.on_stop(scheduler.close)
    app.ready_when(scheduler.unready)


def _parts(app: App) -> Parts:
    ros, site = app.ros, app.site
    hosts, disk = Hosts(ros), GroupCommit(app.log)
    journal, records = Journal(ros, app.log, disk, site.state), Records(site.state, disk)
    records.check()
    runs = ActiveRuns()
    leases = Leases(app, runs)
    places = PlaceRequests(app, records.names, leases.scheduler.owns)
    interrupted = Interrupted(app, journal, records, places)
    gateways = Gateways(app, interrupted.receipt)
    monitors = Monitors(app.log, site.file.groot.bind, site.file.ports.groot)
    numbers, shared = Numbers(site.state, disk), SharedRecords(ros)
    check, publisher = (
        TaskCheck(app, runs, OtherRuns(app, leases.scheduler), gateways, places.site),
        RunsPublisher(ros, runs, leases.scheduler.named("runs")),
    )
    return Parts(
        app, disk, journal, records, numbers, shared, hosts, gateways, monitors, interrupted, runs, publisher, check,
        places, leases,
    )  # fmt: skip


class Scheduler:
    """Serves requests that concern all active runs."""

    def __init__(self, parts: Parts) -> None:
        self._parts, self._runs = parts, parts.runs

    def unready(self) -> Reason | None:
        """Why the scheduler cannot work: it needs the database."""
        return None if self._parts.app.ros.has_service(GetTask, "/tms/db/get_task") else WaitingFor("tms:db")

    def answer(self, request: AnswerQuestion.Request, response: AnswerQuestion.Response) -> AnswerQuestion.Response:
        """Take an operator's answer to a WaitForClick node."""
        if not self._parts.publisher.questions.answer(request.id, request.yes, request.by or "an operator"):
            gone = NoQuestion(request.id)
            response.error_code, response.error_msg = gone.code, to_line(gone)
        return response

    def cancel(self, request: CancelRun.Request, response: CancelRun.Response) -> CancelRun.Response:
        """Ask a run to stop; its result reports the end."""
        run = self._runs.find(request.run_id)
        if run is None:
            none = NoRun(request.run_id, self._runs.names())
            response.error_code, response.error_msg = none.code, to_line(none)
        else:
            run.cancel()
        return response

    def measure(self) -> None:
        """Update the metrics of the active runs, and raise alarms about their history."""
        for alarm in self._parts.journal.alarms():
            self._parts.app.log.error("alarm", reason=alarm)
            for run in self._runs:
                run.log_event("alarm", "", alarm)
        self._parts.publisher.measure()

    def close(self) -> None:
        """Let the runs stop their machines, as the process ends; the runtime waits a moment for their threads."""
        runs = list(self._runs)
        for run in runs:
            run.cancel("interrupted", SchedulerStopped())
        deadline = monotonic() + 1.0
        for run in runs:
            run.ended.wait(max(0.0, deadline - monotonic()))
        self._parts.publisher.close()
        self._parts.disk.close(DISK_END)
        self._parts.journal.close()
