"""Goals that this process serves, each in a worker thread.

Blocking callbacks in a MultiThreadedExecutor starve cancels, and `async` execute callbacks hang (measured with the
rclpy in use); so rclpy's execute callback is never used.
"""

import threading
from collections.abc import Awaitable, Callable
from typing import Any, Generic

from prometheus_client import Counter, Histogram
from rclpy.action import CancelResponse, GoalResponse
from rclpy.action.server import ServerGoalHandle
from structlog.contextvars import bind_contextvars

from tms_config.clock import monotonic, sleep
from tms_decision.reasons import ProcessLost
from tms_interfaces.generated import ActionType, F, G, R
from tms_reason.reason import Reason
from tms_reason.wire import to_line
from tms_ros.goals import Accept, Ended, Outcome
from tms_ros.loop import POLL, EventLoop
from tms_ros.privates import NamingActionServer
from tms_ros.quality import SERVICE
from tms_ros.reasons import BeingStopped, StoppedMeanwhile

RESULT_KEPT = 10  # s that a server keeps a result; every status message lists all kept goals

GOALS = Counter("tms_action_goals_total", "Goals served, by action and outcome", ["action", "outcome"])
SECONDS = Histogram(
    "tms_action_goal_seconds", "From the acceptance of a goal to its end", ["action"],
    buckets=(0.1, 0.5, 1, 2, 5, 10, 30, 60, 300, 1800),
)  # fmt: skip


class Goal(Generic[G, F]):
    """A goal that this process serves, as its worker thread sees it."""

    def __init__(self, handle: ServerGoalHandle, action_type: ActionType[G, R, F]) -> None:
        self._handle, self._type = handle, action_type
        self.request: G = handle.request
        self.uuid = bytes(handle.goal_id.uuid)
        self.id = self.uuid.hex()
        self.cancelled = threading.Event()
        self.on_cancel: Callable[[], None] | None = None  # called once, on the executor thread

    def publish(self, feedback: F) -> None:
        """Send feedback; does nothing once the goal has ended."""
        if self._handle.is_active:
            self._handle.publish_feedback(feedback)

    def say(self, reason: Reason) -> None:
        """Send a reason as feedback, where the type of feedback has room for one."""
        feedback = _saying(self._type, reason)
        if feedback is not None:
            self.publish(feedback)

    def cancel(self) -> None:
        """Handle a cancel request; also called when the process stops."""
        first = not self.cancelled.is_set()
        self.cancelled.set()
        step = self.on_cancel  # a copy: its worker may end this moment
        if first and step is not None:
            step()


AnyGoal = Goal[Any, Any]  # of any action


class ActionServers:
    """The actions that one node serves, and their open goals."""

    def __init__(self, loop: EventLoop) -> None:
        self._loop = loop
        # By action and id; a goal as an attribute of its handle would be a cycle, which is freed late.
        self._goals: dict[tuple[str, bytes], AnyGoal] = {}
        self._leaving = False

    def leave(self, seconds: float) -> None:
        """Cancel the served goals and give their workers `seconds` to stop the motions."""
        self._leaving = True
        for goal in list(self._goals.values()):
            goal.cancel()
        deadline = monotonic() + seconds
        while self._goals and monotonic() < deadline:
            sleep(POLL)

    def serve(
        self,
        action_type: ActionType[G, R, F],
        name: str,
        run: Callable[[Goal[G, F]], Ended[R]],
        accept: Accept[G] | None = None,
    ) -> None:
        """Serve an action: `accept` runs on the executor thread, then `run` in a worker thread per goal.

        `run` must return soon after `goal.cancelled` is set. When it raises, the goal is aborted and the
        traceback logged.
        """

        async def decide(request: G) -> GoalResponse:
            goal_id = server.arriving  # valid until the first await
            verdict = accept(request) if accept is not None else None
            if isinstance(verdict, Awaitable):
                verdict = await verdict
            if verdict is None and self._leaving:
                verdict = ProcessLost(BeingStopped(self._loop.process))
            if verdict is None:
                return GoalResponse.ACCEPT
            GOALS.labels(name, "rejected").inc()
            self._loop.node.get_logger().debug(f"{name}: {verdict!r}")
            feedback = _saying(action_type, verdict)
            if feedback is not None:
                server.tell(goal_id, feedback)
            return GoalResponse.REJECT

        server = NamingActionServer(
            self._loop.node, action_type, name, execute_callback=_never, goal_callback=decide,
            handle_accepted_callback=lambda handle: self._accepted(action_type, run, handle, name),
            cancel_callback=lambda handle: self._cancel(name, handle), result_timeout=RESULT_KEPT,
            callback_group=self._loop.group,
            goal_service_qos_profile=SERVICE, result_service_qos_profile=SERVICE, cancel_service_qos_profile=SERVICE,
        )  # fmt: skip

    def _accepted(
        self, kind: ActionType[G, R, F], run: Callable[[Goal[G, F]], Ended[R]], handle: ServerGoalHandle, name: str
    ) -> None:
        goal = Goal(handle, kind)
        self._goals[name, goal.uuid] = goal
        if self._leaving:  # it began to leave after the decision
            goal.cancel()
        self._loop.in_thread(lambda: self._work(kind, run, goal, name))

    def _cancel(self, name: str, handle: ServerGoalHandle) -> CancelResponse:
        goal = self._goals.get((name, bytes(handle.goal_id.uuid)))
        if goal is not None:  # else it has ended and its result is being delivered
            goal.cancel()
        return CancelResponse.ACCEPT

    def _work(
        self, action_type: ActionType[G, R, F], run: Callable[[Goal[G, F]], Ended[R]], goal: Goal[G, F], name: str
    ) -> None:
        bind_contextvars(goal=goal.id)
        begun = monotonic()
        ended: Ended[R] = (Outcome.ABORTED, action_type.Result())
        try:
            ended = run(goal)
        finally:
            goal.on_cancel = None  # it refers to the goal's objects, and they refer to the goal
            SECONDS.labels(name).observe(monotonic() - begun)
            GOALS.labels(name, ended[0].name.lower()).inc()
            self._loop.on_executor(lambda: self._deliver(name, goal, *ended))

    def _deliver(self, name: str, goal: Goal[G, F], outcome: Outcome, result: R) -> None:
        asked = goal._handle.is_cancel_requested
        if self._leaving and outcome is Outcome.CANCELED and not asked:
            goal.say(ProcessLost(StoppedMeanwhile(self._loop.process)))

        def finish(handle: ServerGoalHandle) -> R:
            if outcome is Outcome.SUCCEEDED:
                handle.succeed()
            elif outcome is Outcome.CANCELED and asked:
                handle.canceled()
            else:  # rcl allows CANCELED only after a cancel request
                handle.abort()
            return result

        self._goals.pop((name, goal.uuid))
        goal._handle.execute(finish)


def _saying(action_type: ActionType[G, R, F], reason: Reason) -> F | None:
    """Feedback that is only a reason; None where its type has no room for one."""
    kind: Any = action_type.Feedback
    known = kind.get_fields_and_field_types()
    field = next((name for name in ("status", "state") if known.get(name) == "string"), None)
    return None if field is None else kind(**{field: to_line(reason)})


def _never(handle: ServerGoalHandle) -> None:
    raise AssertionError("goals are executed by their own worker threads")
