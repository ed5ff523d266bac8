"""Runs as the API commands them: blocking calls of the scheduler, for worker threads."""

import json
from typing import Any

from rcl_interfaces.srv import GetParameters
from tms_msg_ts import srv
from tms_msg_ts.action import ExecuteTask

from tms_config.config import Site
from tms_interfaces.generated import Reply, Req, ServiceType
from tms_reason.errors import RosError, TmsError
from tms_reason.names import check_sent
from tms_ros.node import Ros
from tms_schedulers.asking import of_all, of_any, of_its_own
from tms_schedulers.names import Scheduler, schedulers
from tms_schedulers.reasons import RunNotBegun
from tms_schedulers.sending import ExecuteCall, ExecutePeer, send
from tms_ur.answers import checked, error_in
from tms_ur.reasons import StartRefused
from tms_ur.start_models import ResumePlan

SCHEDULER = "tms:ts"
CALL_LIMIT = 4.0  # s for an answer of a module
NO_RUN, NO_QUESTION = "NO_RUN", "NO_QUESTION"  # codes of a scheduler that does not know them
START_LIMIT = 30.0  # s for a run to begin; the scheduler may have to start its subtasks first


class RunCalls:
    """What is asked of the scheduler about runs; the base of the site's client."""

    def __init__(self, ros: Ros, site: Site) -> None:
        self._ros, self._site = ros, site
        self._schedulers = {one: ros.peer(ExecuteTask, one.named("execute_task")) for one in schedulers(site)}

    def start_run(self, task_id: int, ignore_warnings: bool, resume: str = "") -> str:
        """Start a task, or resume an interrupted run whatever the task, and return the run's id once it has begun.

        Raises:
            TmsError: refused, with the scheduler's reason; or the scheduler is away. Nothing runs then.
        """
        goal = ExecuteTask.Goal(task_id=task_id, ignore_warnings=ignore_warnings, resume=resume)
        return of_its_own(self._site, lambda one: self._start(self._schedulers[one], goal), NO_RUN)

    def _start(self, scheduler: ExecutePeer, goal: ExecuteTask.Goal) -> str:
        call = send(scheduler, goal)
        call.wait_for(lambda: _begun(call) or call.outcome is not None, START_LIMIT)
        if call.outcome is None and call.feedback is not None:  # it runs, or takes long to prepare
            return str(call.feedback.run_id)
        if call.outcome is None:  # the caller gets an error, so the run must not start later
            scheduler.cancel(call)
            raise RosError(RunNotBegun(START_LIMIT, SCHEDULER))
        if call.result is None:
            raise TmsError(StartRefused(SCHEDULER))
        if call.result.outcome == "refused":
            raise error_in(call.result)
        return str(call.result.run_id)  # it ended before its first feedback

    def cancel_run(self, run_id: str) -> None:
        """Cancel a run; its state shows when it has ended.

        Raises:
            TmsError: NO_RUN, or the scheduler is away.
        """
        self._ask_any(srv.CancelRun, "cancel_run", NO_RUN, run_id=run_id)

    def resume_plan(self, run_id: str) -> ResumePlan:
        """What resuming an interrupted run would do first.

        Raises:
            TmsError: NO_RUN, or the scheduler is away.
        """
        found = self._ask_any(srv.ResumePlan, "resume_plan", NO_RUN, run_id=run_id)
        return ResumePlan(task_id=found.task_id, done=list(found.done), next=list(found.next))

    def blackboard(self, run_id: str, node: str) -> dict[str, Any]:
        """What the node at a path of an active run sees of what others have written; nothing of a run that is over.

        Raises:
            TmsError: the scheduler is away.
        """
        request = GetParameters.Request(names=[run_id, node])
        check_sent("blackboard", request)

        def ask(scheduler: Scheduler) -> dict[str, Any]:
            (found,) = self._ros.call(GetParameters, scheduler.named("blackboard"), request, CALL_LIMIT).values
            return dict(json.loads(found.string_value)) if found.string_value else {}

        answers, refusals = of_all(self._site, ask)
        if refusals and not any(answers):
            raise refusals[0]
        return next(filter(None, answers), {})

    def abandon_run(self, run_id: str) -> None:
        """Give up an interrupted run for good.

        Raises:
            TmsError: NO_RUN, or the scheduler is away.
        """
        self._ask_any(srv.CancelRun, "abandon_run", NO_RUN, run_id=run_id)

    def answer(self, question: str, yes: bool, by: str) -> None:
        """Answer a WaitForClick node.

        Raises:
            TmsError: NO_QUESTION, or the scheduler is away.
        """
        self._ask_any(srv.AnswerQuestion, "answer", NO_QUESTION, id=question, yes=yes, by=by)

    def _ask_any(self, service_type: ServiceType[Req, Reply], name: str, unknown: str, **fields: Any) -> Reply:
        """The answer of the scheduler that knows what is asked."""
        return of_any(self._site, lambda one: self._ask(service_type, one.named(name), **fields), unknown)

    def _ask(self, service_type: ServiceType[Req, Reply], name: str, **fields: Any) -> Reply:
        request_type: Any = service_type.Request
        request: Req = request_type(**fields)
        check_sent(name, request)
        return checked(self._ros.call(service_type, name, request, CALL_LIMIT))


def _begun(call: ExecuteCall) -> bool:
    """Whether the run has begun; before that it only prepares and may be refused."""
    return call.feedback is not None and call.feedback.state != "preparing"
