"""Goals that this process sends.

- Goals are sent on the executor thread only: rclpy notes a goal's sequence number after sending it, so
  with another thread the answer can come first and is lost.
- A client takes all feedback before the result, since rclpy forgets the feedback callback with the result
  and the last feedback carries the reason of a failure.
"""

import threading
from collections.abc import Callable
from typing import Any, Generic
from uuid import uuid4

from rclpy.action.client import ClientGoalHandle
from rclpy.task import Future
from unique_identifier_msgs.msg import UUID

from tms_config.clock import monotonic
from tms_config.naming import process_of
from tms_interfaces.generated import ActionType, F, G, R
from tms_ros.goals import Outcome
from tms_ros.loop import EventLoop
from tms_ros.privates import SureActionClient
from tms_ros.quality import SERVICE
from tms_ros.reasons import NoServer

UNKNOWN_GOAL = 2  # action_msgs/CancelGoal: the server does not know the goal, so it was restarted
STAYS = 0.5  # s for which a server counts as there after a look, which goes through the whole graph of the site
DISCOVERY_LEASE = 6.0  # s after which discovery itself has dropped a dead process (5 s in our DDS profile)


class Call(Generic[R, F]):
    """A goal that this process sent. All fields are set on the executor thread, readable from any."""

    def __init__(
        self, goal_id: bytes, on_change: Callable[["Call[R, F]"], None] | None, on_feedback: Callable[[F], None] | None
    ) -> None:
        self.id = goal_id
        self.accepted = False
        self.outcome: Outcome | None = None  # set once the goal is terminal
        self.result: R | None = None  # of a goal that its server ended
        self.feedback: F | None = None  # the last feedback
        self._cancel_wanted = False
        self._handle: Any = None
        self._on_change, self._on_feedback = on_change, on_feedback
        self._changed = threading.Condition()

    def wait_for(self, holds: Callable[[], bool], seconds: float) -> bool:
        """Wait until `holds` after a change of this goal; False when the time is over."""
        with self._changed:
            return self._changed.wait_for(holds, max(0.0, seconds))

    def changed(self) -> None:
        with self._changed:
            self._changed.notify_all()
        if self._on_change is not None:
            self._on_change(self)

    def end(self, outcome: Outcome, result: R | None = None) -> None:
        if self.outcome is None:
            self.result = result
            self.outcome = outcome
            self.changed()

    def received(self, message: Any) -> None:
        self.feedback = message.feedback
        if self._on_feedback is not None:
            self._on_feedback(message.feedback)
        self.changed()

    def answered(self, handle: Any) -> None:
        if not handle.accepted:
            self.end(Outcome.REJECTED)
            return
        self._handle, self.accepted = handle, True
        handle.get_result_async().add_done_callback(self._finished)
        if self._cancel_wanted:  # a cancel before the server's answer must not get lost
            self._send_cancel()
        self.changed()

    def _finished(self, future: Future) -> None:
        answer = future.result()
        known = {o.value: o for o in (Outcome.SUCCEEDED, Outcome.CANCELED, Outcome.ABORTED)}
        self.end(known.get(answer.status, Outcome.LOST), answer.result)

    def ask_again(self) -> None:
        """Ask for the result once more: the reply to a very new client may get lost before discovery is complete."""
        if self._handle is not None and self.outcome is None:
            self._handle.get_result_async().add_done_callback(self._finished)

    def resolve_unanswered(self, handle: ClientGoalHandle) -> None:
        """Cancel a goal without an answer: a server that does not know it reports that, any other one ends it."""
        if self._handle is None and self.outcome is None:
            self._cancel_wanted = True  # in case the answer comes after all
            handle.cancel_goal_async()
            handle.get_result_async().add_done_callback(self._finished)

    def cancel_now(self) -> None:
        self._cancel_wanted = True
        if self._handle is not None and self.outcome is None:
            self._send_cancel()

    def _send_cancel(self) -> None:
        self._handle.cancel_goal_async().add_done_callback(self._cancel_answered)

    def _cancel_answered(self, future: Future) -> None:
        answer = future.result()
        if answer is not None and answer.return_code == UNKNOWN_GOAL:
            self.end(Outcome.LOST)


AnyCall = Call[Any, Any]  # of any action


class Peer(Generic[G, R, F]):
    """An action server elsewhere, and the client for it."""

    def __init__(self, loop: EventLoop, action_type: ActionType[G, R, F], name: str) -> None:
        self._loop, self.name = loop, name
        self._open: list[Call[R, F]] = []  # used on the executor thread only
        self._taken_by: frozenset[bytes] = frozenset()  # servers that could have taken the last goal
        self._found: frozenset[bytes] = frozenset()  # servers at the last look; empty unless they were connected
        self._dead_until = self._there_until = float("-inf")  # monotonic [s], see STAYS
        self._dead: frozenset[bytes] = frozenset()  # servers that are known to be gone, before discovery drops them
        self._client = SureActionClient(
            loop.node, action_type, name, callback_group=loop.group, goal_service_qos_profile=SERVICE,
            result_service_qos_profile=SERVICE, cancel_service_qos_profile=SERVICE,
        )  # fmt: skip

    def ready(self) -> bool:
        """Whether a server is there and connected in both directions."""
        now = monotonic()
        if self._dead and (now > self._dead_until or self._servers() - self._dead):
            self._dead = frozenset()
        if now > self._there_until:
            found = self._servers()  # of these once connected, no more is asked: rcl takes eight such looks
            there = found and (found == self._found or self._client.server_is_ready())
            self._found, self._there_until = (found, now + STAYS) if there else (frozenset(), float("-inf"))
        return not self._dead and now <= self._there_until

    def left(self) -> bool:
        """Whether every server that could have taken the last goal is gone; a successor does not know the goal."""
        taken = self._taken_by  # that it is not there is looked for anew: only good news counts for a while
        return not self.ready() or bool(taken and not taken & self._found and not taken & self._servers())

    def mark_alive(self) -> None:
        """Note that the server was not dead, only frozen for a while."""
        self._dead = frozenset()

    def _servers(self) -> frozenset[bytes]:
        """The servers of this name; the status topic is the last thing that a new one announces."""
        found = self._loop.node.get_publishers_info_by_topic(f"{self.name}/_action/status")
        return frozenset(bytes(info.endpoint_gid) for info in found)

    def wait_ready(self, seconds: float) -> None:
        """Block until the server is there; raises RosError when it does not come."""
        self._loop.wait_for(self.ready, seconds, NoServer(process_of(self.name), self.name, seconds))

    def send(
        self,
        goal: G,
        *,
        goal_id: bytes | None = None,
        on_change: Callable[[Call[R, F]], None] | None = None,
        on_feedback: Callable[[F], None] | None = None,
    ) -> Call[R, F]:
        """Send a goal and return at once; `on_*` run on the executor thread and must be quick."""
        call = Call(goal_id or uuid4().bytes, on_change, on_feedback)

        def send() -> None:
            for other in self._open:
                if other.outcome is not None:
                    self._client.forget(other.id)
            self._open = [other for other in self._open if other.outcome is None] + [call]
            future = self._client.send_goal_async(goal, call.received, UUID(uuid=list(call.id)))
            future.add_done_callback(lambda done: call.answered(done.result()))
            self._taken_by = self._servers()  # after sending, as it takes a while

        self._loop.on_executor(send)
        return call

    def mark_lost(self) -> None:
        """End the goals that the server has accepted: its process is gone, so they never end by themselves.

        Discovery counts it for some seconds more, and its successor has the same name. A goal sent before the
        successor serves would get lost, so `ready` waits for a server that is not one of the old ones.
        """
        self._dead, self._dead_until = self._taken_by, monotonic() + DISCOVERY_LEASE
        self._there_until = float("-inf")
        self._loop.on_executor(self._end_open)

    def _end_open(self) -> None:
        for call in self._open:
            if call.accepted:
                call.end(Outcome.LOST)

    def ask_again(self, call: Call[R, F]) -> None:
        """Ask once more for a result that is overdue. Returns at once."""
        self._loop.on_executor(call.ask_again)

    def resolve_unanswered(self, call: Call[R, F]) -> None:
        """Give up a goal that was not answered in time; it ends as LOST if the server does not know it."""
        self._loop.on_executor(lambda: call.resolve_unanswered(self._client.handle_of(call.id)))

    def cancel(self, call: Call[R, F]) -> None:
        """Cancel a goal, also before it was accepted. Returns at once."""
        self._loop.on_executor(call.cancel_now)


AnyPeer = Peer[Any, Any, Any]  # of any action
