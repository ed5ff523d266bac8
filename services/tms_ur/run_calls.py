"""Runs as the API commands them: blocking calls of the scheduler, for worker threads."""

import json
from typing import Any

from rcl_interfaces.srv import GetParameters
from tms_msg_ts import srv
from tms_msg_ts.action import ExecuteTask

from tms_interfaces.generated import Reply, Req, ServiceType
from tms_reason.errors import RosError, TmsError
from tms_reason.names import check_sent
from tms_ros.client import Call
from tms_ros.node import Ros
from tms_ur.answers import checked, error_in
from tms_ur.reasons import RunNotBegun, StartRefused
from tms_ur.start_models import ResumePlan

SCHEDULER = "tms:ts"
CALL_LIMIT = 4.0  # s for an answer of a module
START_LIMIT = 30.0  # s for a run to begin; the scheduler may have to start its subtasks first


class RunCalls:
    """What is asked of the scheduler about runs; the base of the site's client."""

    def __init__(self, ros: Ros) -> None:
        self._ros = ros
        self._scheduler = ros.peer(ExecuteTask, "/tms/execute_task")

    def start_run(self, task_id: int, ignore_warnings: bool, resume: str = "") -> str:
        """Start a task, or resume an interrupted run whatever the task, and return the run's id once it has begun.

        Raises:
            TmsError: refused, with the scheduler's reason; or the scheduler is away. Nothing runs then.
        """
        self._scheduler.wait_ready(CALL_LIMIT)
        call = self._scheduler.send(ExecuteTask.Goal(task_id=task_id, ignore_warnings=ignore_warnings, resume=resume))
        call.wait_for(lambda: _begun(call) or call.outcome is not None, START_LIMIT)
        if call.outcome is None and call.feedback is not None:  # it runs, or takes long to prepare
            return str(call.feedback.run_id)
        if call.outcome is None:  # the caller gets an error, so the run must not start later
            self._scheduler.cancel(call)
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
        self._ask(srv.CancelRun, "/tms/cancel_run", run_id=run_id)

    def resume_plan(self, run_id: str) -> ResumePlan:
        """What resuming an interrupted run would do first.

        Raises:
            TmsError: NO_RUN, or the scheduler is away.
        """
        found = self._ask(srv.ResumePlan, "/tms/resume_plan", run_id=run_id)
        return ResumePlan(task_id=found.task_id, done=list(found.done), next=list(found.next))

    def blackboard(self, run_id: str, node: str) -> dict[str, Any]:
        """What the node at a path of an active run sees of what others have written; nothing of a run that is over.

        Raises:
            TmsError: the scheduler is away.
        """
        request = GetParameters.Request(names=[run_id, node])
        check_sent("/tms/blackboard", request)
        (found,) = self._ros.call(GetParameters, "/tms/blackboard", request, CALL_LIMIT).values
        return dict(json.loads(found.string_value)) if found.string_value else {}

    def abandon_run(self, run_id: str) -> None:
        """Give up an interrupted run for good.

        Raises:
            TmsError: NO_RUN, or the scheduler is away.
        """
        self._ask(srv.CancelRun, "/tms/abandon_run", run_id=run_id)

    def answer(self, question: str, yes: bool, by: str) -> None:
        """Answer a WaitForClick node.

        Raises:
            TmsError: NO_QUESTION, or the scheduler is away.
        """
        self._ask(srv.AnswerQuestion, "/tms/answer", id=question, yes=yes, by=by)

    def _ask(self, service_type: ServiceType[Req, Reply], name: str, **fields: Any) -> Reply:
        request_type: Any = service_type.Request
        request: Req = request_type(**fields)
        check_sent(name, request)
        return checked(self._ros.call(service_type, name, request, CALL_LIMIT))


def _begun(call: Call[ExecuteTask.Result, ExecuteTask.Feedback]) -> bool:
    """Whether the run has begun; before that it only prepares and may be refused."""
    return call.feedback is not None and call.feedback.state != "preparing"
