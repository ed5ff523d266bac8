"""Runs the preflight of a stored task, of XML, and of a run before it begins."""

from tms_msg_db.msg import Task
from tms_msg_db.srv import GetTask, GetTemplate
from tms_msg_rp.srv import CheckMotion
from tms_msg_ts.srv import CheckTask

from tms_config.clock import monotonic, sleep
from tms_decision.reasons import MachineLatched
from tms_kit.rehearsal import service_of
from tms_kit.site_places import SitePlaces
from tms_reason.errors import TaskError, TmsError
from tms_reason.reason import Reason
from tms_reason.wire import refusal, to_line
from tms_runtime.app import App
from tms_ts import bt
from tms_ts.active_runs import ActiveRuns
from tms_ts.gateways import Gateways
from tms_ts.other_runs import OtherRuns
from tms_ts.place_check import check_places, leaves_of
from tms_ts.preflight import Findings, at, preflight
from tms_ts.reasons import MachineBusy
from tms_ts.surroundings import CHECK_PERIOD, DISCOVERY_LIMIT, PreflightContext, SensingInputs

DB_LIMIT = 5.0  # s


class TaskCheck:
    """Reads tasks from the database and checks them against the site as it is now."""

    def __init__(self, app: App, runs: ActiveRuns, others: OtherRuns, gateways: Gateways, places: SitePlaces) -> None:
        self._app, self._runs, self._others = app, runs, others
        self._gateways, self._places = gateways, places
        self._sensing = SensingInputs(app)
        for machine in app.site.file.machines:
            if app.site.model_of(machine).planner is not None:
                app.ros.prepare(CheckMotion, service_of(machine))

    def check(self, request: CheckTask.Request, response: CheckTask.Response) -> CheckTask.Response:
        """Preflight of a stored task or of XML, without running."""
        try:
            xml = request.xml if request.task_id == 0 else self.task(request.task_id).task_sequence
            report = bt.check(xml, templates=self.template)
            if report.ok:
                tree = bt.load(xml, world=None, templates=self.template)
                found = self._preflight(tree, present=True, motions=not request.without_motions)
                response.errors = list(map(to_line, found.errors))
                response.warnings = list(map(to_line, found.warnings))
            else:
                response.errors = [to_line(error.reason) for error in report.errors]
                response.warnings = [to_line(at(line, what)) for line, what in report.warnings]
        except TmsError as error:
            response.error_code, response.error_msg = error.code, to_line(error.reason)
        return response

    def task(self, task_id: int) -> Task:
        """A stored task.

        Raises:
            TaskError: there is none of this number.
            RosError: the database does not answer.
        """
        answer = self._app.ros.call(GetTask, "/tms/db/get_task", GetTask.Request(task_id=task_id), DB_LIMIT)
        if answer.error_code:
            raise TaskError(refusal(answer.error_code, answer.error_msg), answer.error_code)
        return answer.task

    def template(self, name: str) -> str | None:
        """The text of a stored template; None if there is none of this name.

        Raises:
            TaskError: it cannot be read.
            RosError: the database does not answer.
        """
        request = GetTemplate.Request(template_name=name)
        answer = self._app.ros.call(GetTemplate, "/tms/db/get_template", request, DB_LIMIT)
        if answer.error_code == "TEMPLATE_MISSING":
            return None
        if answer.error_code:
            raise TaskError(refusal(answer.error_code, answer.error_msg), answer.error_code)
        return answer.stored.task_sequence

    def before_run(self, tree: bt.Tree) -> Findings:
        """Preflight of a run that is about to begin; whether its machines may move now is checked later."""
        return self._preflight(tree, present=False, motions=True)

    def refuse_latched(self, machines: list[str]) -> None:
        """Refuse to begin a run unless its machines are armed and free.

        Raises:
            TaskError: why one of them may not move now; NOT_ARMED if it is latched.
        """
        for machine in machines:
            found = self._gateways.held_back(machine)
            if found is not None:
                raise not_free(found)

    def _preflight(self, tree: bt.Tree, present: bool, motions: bool) -> Findings:
        """`present`: also report why machines may not move now; a run is refused for that later."""
        problem = self._problem if present else _no_problem
        site = self._app.site
        around = PreflightContext(self._app, self._sensing, problem, self._written, motions)
        found = preflight(tree, site, around)
        if leaves_of(tree):
            orders = {**self._others.orders(), **self._runs.orders()}  # no machine is in runs of both
            about = check_places(tree, site, self._known_places(), orders)
            found.errors += about.errors
            found.warnings += about.warnings
        return found

    def _written(self, record: str, field: str) -> bool:
        return self._runs.writes(record, field) or self._others.writes(record, field)

    def _known_places(self) -> tuple[str, ...]:
        """The places of the site; waits a moment for their keeper, which this process may have found just now."""
        until = monotonic() + DISCOVERY_LIMIT
        while (names := self._places.names) is None and monotonic() < until:
            sleep(CHECK_PERIOD)
        return names or ()

    def _problem(self, machine: str) -> Reason | None:
        holder = self._runs.holder(machine)
        return MachineBusy(machine, holder) if holder is not None else self._gateways.obstacle(machine)


def _no_problem(_machine: str) -> None:
    return None


def not_free(why: Reason) -> TaskError:
    """The error of a run whose machine may not move now; NOT_ARMED if it is latched."""
    return TaskError(why, "NOT_ARMED" if isinstance(why, MachineLatched) else why.code)
