"""All uses of rclpy's private parts, with executor.py; tests/ros/test_privates.py checks a new release for them."""

import warnings
from collections.abc import Callable
from typing import Any

from rclpy.action import ActionClient, ActionServer
from rclpy.action.client import ClientGoalHandle
from rclpy.callback_groups import CallbackGroup
from rclpy.exceptions import InvalidHandle
from unique_identifier_msgs.msg import UUID

from tms_config.clock import monotonic, unix_ns

DROPPED = "failed to send response"
AGAIN = 0.5  # s until the next attempt: each may hold the executor for 0.1 s
ATTEMPTS = 6  # clients wait 5 s, and ask again themselves if they must

Later = Callable[[float, Callable[[], None]], None]


def send_surely(service: Any, later: Later) -> None:
    """Have a service send answers again that rmw drops, and no answer for None; on the executor thread.

    A client discovers a server a moment before the server discovers the client's reader, and more while a whole site
    starts. rmw waits 0.1 s for the reader, then drops the answer with a warning; the client would wait in vain.
    """
    send = service.send_response

    def attempt(response: Any, header: Any, left: int) -> None:
        with warnings.catch_warnings(record=True) as shown:
            warnings.simplefilter("always")
            try:
                send(response, header)
            except InvalidHandle:  # the service was destroyed meanwhile, and an exception would end the executor
                return
        dropped = [one for one in shown if DROPPED in str(one.message)]  # rclpy has no other sign of it
        if dropped and left > 1:
            later(AGAIN, lambda: attempt(response, header, left - 1))
        for one in shown if not dropped or left == 1 else ():
            warnings.warn_explicit(one.message, one.category, one.filename, one.lineno)

    def respond(response: Any, header: Any) -> None:
        if callable(response):  # it gets what sends the answer later: a coroutine would run at each wake-up till then
            response(lambda filled: respond(filled, header))
        elif response is not None:
            attempt(response, header, ATTEMPTS)

    service.send_response = respond


def take(subscription: Any) -> tuple[Any, float, int] | None:
    """The oldest waiting message, when it was received [s, monotonic], and its number by its publisher."""
    with subscription.handle:
        taken = subscription.handle.take_message(subscription.msg_type, False)
    if taken is None:
        return None
    message, way = taken
    waited = max(0.0, (unix_ns() - way["received_timestamp"]) * 1e-9)  # the middleware uses wall time
    return message, monotonic() - waited, way["publication_sequence_number"]


class Asleep(CallbackGroup):  # type: ignore[misc]
    """The group of subscriptions that must not wake the executor."""

    def can_execute(self, entity: Any) -> bool:
        """Never."""
        return False


class NamingActionServer(ActionServer):  # type: ignore[misc]
    """An action server that gives its goal callback the id of the arriving goal."""

    arriving: Any = None

    async def _execute_goal_request(self, request_header_and_message: Any) -> None:
        self.arriving = request_header_and_message[1].goal_id
        await super()._execute_goal_request(request_header_and_message)

    def tell(self, goal_id: UUID, feedback: Any) -> None:
        """Send feedback of a goal that is not accepted."""
        self._handle.publish_feedback(self.action_type.Impl.FeedbackMessage(goal_id=goal_id, feedback=feedback))


class SureActionClient(ActionClient):  # type: ignore[misc]
    """An action client that takes all waiting feedback before a result or a rejection.

    A server drops its answer while it has not yet discovered a client that has long discovered it; its status topic,
    which is latched, then shows that the goal was accepted.
    """

    def __init__(self, *args: Any, **settings: Any) -> None:
        super().__init__(*args, **settings)
        self._known_by_status: set[int] = set()  # goal requests whose answer may still come
        self._due = False  # whether an answer may come

    def add_to_wait_set(self, wait_set: Any) -> None:
        """Wait while an answer is due only, as the executor does for services."""
        self._due = bool(self._pending_goal_requests or self._pending_cancel_requests or self._pending_result_requests)
        if self._due:
            super().add_to_wait_set(wait_set)

    def is_ready(self, wait_set: Any) -> bool:
        """Whether something is there to take."""
        return self._due and bool(super().is_ready(wait_set))

    def take_data(self) -> dict[str, Any]:
        """Take the waiting data, with all feedback."""
        data: dict[str, Any] = super().take_data()
        first = data.pop("feedback", None)
        waiting = [] if first is None else [first]
        if "goal" in data or "result" in data:
            while (message := self._client_handle.take_feedback(self._action_type.Impl.FeedbackMessage)) is not None:
                waiting.append(message)
        return {"waiting": waiting, **data}

    async def execute(self, taken_data: dict[str, Any]) -> None:
        """Handle feedback first, then answers, then the acceptances that statuses show."""
        for message in taken_data.pop("waiting"):
            await super().execute({"feedback": message})
        if "goal" in taken_data and taken_data["goal"][0] in self._known_by_status:
            self._known_by_status.discard(taken_data.pop("goal")[0])
        await super().execute(taken_data)
        for status in taken_data["status"].status_list if "status" in taken_data else ():
            await self._accepted_by(status)

    async def _accepted_by(self, status: Any) -> None:
        wanted = bytes(status.goal_info.goal_id.uuid)
        for number, goal_id in list(self._goal_sequence_number_to_goal_id.items()):
            if bytes(goal_id.uuid) == wanted and wanted not in self._goal_handles:
                self._known_by_status.add(number)
                answer = self._action_type.Impl.SendGoalService.Response(accepted=True, stamp=status.goal_info.stamp)
                await super().execute({"goal": (number, answer)})

    def forget(self, goal_id: bytes) -> None:
        """Drop what is kept of a goal that has ended; rclpy itself waits for its result, and then for its status."""
        for kept in (self._feedback_callbacks, self._goal_handles):
            kept.pop(goal_id, None)

    def handle_of(self, goal_id: bytes) -> ClientGoalHandle:
        """A handle for a goal without an answer, to ask the server whether it has the goal after all."""
        answer = self._action_type.Impl.SendGoalService.Response(accepted=True)
        return ClientGoalHandle(self, UUID(uuid=list(goal_id)), answer)
