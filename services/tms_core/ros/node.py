"""A node, its executor thread, and calls that are safe from any thread.

Why it is built this way (all measured with the rclpy in use):
- One SingleThreadedExecutor in a thread of its own.
- All callbacks share a reentrant group: with rclpy's default group, a callback that awaits an answer
  keeps the answer from being delivered. One thread runs them all, so nothing runs at the same time.
"""

import threading
import time
from collections.abc import Awaitable, Callable
from typing import Any, TypeVar

import rclpy
from rclpy.callback_groups import CallbackGroup, ReentrantCallbackGroup
from rclpy.context import Context
from rclpy.duration import Duration
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.exceptions import InvalidHandle
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rclpy.task import Future

from tms_core.errors import RosError
from tms_core.pulse import Pulse
from tms_core.ros import quality
from tms_core.ros.answers import send_surely
from tms_core.ros.client import Peer
from tms_core.ros.goals import Accept, Ended, InterfaceType, Message, Request, Response
from tms_core.ros.server import Goal, Served

T = TypeVar("T")

LAST_WORDS = 0.1  # s for results and reasons to leave before this process does
HANGS = 5.0  # s after which an executor that does not run counts as hanging
LOOK = 0.1  # s between looks whether a server that owes an answer is still there
POLL = 0.02  # s between looks at the ROS graph, which has no cheap event in rclpy


class Ros:
    """One node and the thread that runs its callbacks."""

    def __init__(self, name: str, namespace: str = "/") -> None:
        self._context = Context()
        rclpy.init(context=self._context, signal_handler_options=SignalHandlerOptions.NO)
        self.node: Node = rclpy.create_node(
            name, namespace=namespace, context=self._context, start_parameter_services=False, enable_rosout=False
        )
        self.group = ReentrantCallbackGroup()
        self._executor = _Executor(context=self._context)
        self._executor.add_node(self.node)
        self._clients: dict[tuple[str, str], Any] = {}  # by type and name
        self._peers: dict[str, Peer] = {}
        self._making = threading.Lock()
        self._served = Served(self)
        self._asked: float | None = None  # monotonic time since which the executor has not shown itself
        self.failed = threading.Event()  # the executor thread died of an exception
        self.closing = False  # nothing can be sent any more
        self._thread = threading.Thread(target=self._spin, name="ros", daemon=True)
        self._thread.start()
        self.pulse = Pulse(self.on_executor, lambda: self._executor.busy_since)

    def _spin(self) -> None:
        try:
            self._executor.spin()
        except ExternalShutdownException:
            pass
        finally:
            if not self.closing:
                self.failed.set()

    def close(self, seconds: float = 1.0) -> None:
        """Cancel what is served, give the workers `seconds` to stop their motions, and leave the graph."""
        self._served.leave(seconds)
        time.sleep(LAST_WORDS)
        self.closing = True
        self.pulse.close()
        self._executor.shutdown(timeout_sec=0.5)
        self._thread.join(0.5)
        self.node.destroy_node()
        rclpy.shutdown(context=self._context)

    def on_executor(self, step: Callable[[], None]) -> None:
        """Run `step` on the executor thread, soon."""
        if threading.current_thread() is self._thread:
            step()
        else:
            self._executor.create_task(step)

    def do(self, step: Callable[[], T], seconds: float) -> T:
        """Run `step` on the executor thread and wait for what it returns or raises; from worker threads only.

        Raises:
            RosError: the executor did not come to it within `seconds`.
        """
        there = threading.Event()
        results: list[T] = []
        errors: list[Exception] = []

        def run() -> None:
            try:
                results.append(step())
            except Exception as error:  # raised again in the caller's thread; here it would end the executor
                errors.append(error)
            there.set()

        self.on_executor(run)
        if not there.wait(seconds):
            raise RosError(f"the ROS thread did not answer within {seconds:.0f} s", "BUSY")
        if errors:
            raise errors[0]
        return results[0]

    def hangs(self) -> str | None:
        """Asks the executor to show itself; why it should be restarted when it has not done so since it was asked."""
        asked = self._asked
        if asked is not None:
            seconds = time.monotonic() - asked
            return f"the ROS thread has not run for {seconds:.0f} s" if seconds > HANGS else None
        self._asked = time.monotonic()
        self.on_executor(self._shown)
        return None

    def _shown(self) -> None:
        self._asked = None

    def start(self, step: Callable[[], Awaitable[None]]) -> None:
        """Run a coroutine function on the executor thread."""
        self._executor.create_task(step)

    def promise(self) -> Future:
        """A result that coroutines on the executor thread await; set it there, see `on_executor`."""
        return Future(executor=self._executor)

    def now(self) -> Message:
        """Present time as builtin_interfaces/Time."""
        return self.node.get_clock().now().to_msg()

    def wait_for(self, there: Callable[[], bool], seconds: float, otherwise: str) -> None:
        """Poll `there` until it holds.

        Raises:
            RosError: it did not hold within `seconds`; the message starts with `otherwise`.
        """
        deadline = time.monotonic() + seconds
        while not there():
            if time.monotonic() > deadline:
                raise RosError(f"{otherwise} after {seconds:.1f} s: is its process running? See `tms ps`", "NO_SERVER")
            time.sleep(POLL)

    def ends(self) -> tuple[int, int, int]:
        """Remote readers of our publishers, remote writers of our subscriptions, nodes; on the executor thread."""
        readers = sum(end.get_subscription_count() for end in list(self.node.publishers))
        writers = sum(self.node.count_publishers(end.topic_name) for end in list(self.node.subscriptions))
        return readers, writers, len(self.node.get_node_names())

    # topics

    def publisher(self, message_type: InterfaceType, topic: str, depth: int = 10, latched: bool = False) -> Any:
        """A reliable publisher; `latched` gives the last message to whoever comes later."""
        return self.node.create_publisher(message_type, topic, quality.topic(depth, latched))

    def delivered(self, publisher: Any, seconds: float) -> bool:
        """Wait until all readers have what was published; False: not within `seconds`."""
        return bool(publisher.wait_for_all_acked(Duration(seconds=seconds)))

    def subscribe(
        self,
        message_type: InterfaceType,
        topic: str,
        heard: Callable[[Message], None],
        depth: int = 1,
        latched: bool = False,
        best_effort: bool = False,
    ) -> Any:
        """Call `heard` on the executor thread; depth 1 means that only the latest counts.

        A best-effort subscription also hears reliable publishers, a reliable one hears no best-effort publisher.
        What waits is heard in one go: for each message of its own, the executor does four times the work of a callback.
        """
        subscription: Any = None

        def all_that_wait(message: Message) -> None:
            heard(message)
            if subscription is None:  # this one came before the assignment below
                return
            for _ in range(depth - 1):
                try:
                    waiting = _take(subscription)
                except InvalidHandle:  # `heard` has ended the subscription
                    return
                if waiting is None:
                    return
                heard(waiting)

        subscription = self.node.create_subscription(
            message_type, topic, all_that_wait, quality.topic(depth, latched, best_effort), callback_group=self.group
        )
        return subscription

    def sample(self, message_type: InterfaceType, topic: str, depth: int = 1) -> Callable[[], list[Message]]:
        """What asks for the last `depth` messages that came since it was asked last, oldest first; from any thread.

        Messages do not wake the executor, which costs more than to take them.
        """
        subscription = self.node.create_subscription(
            message_type, topic, _unheard, quality.topic(depth, False, best_effort=True), callback_group=_Asleep()
        )

        def news() -> list[Message]:
            found: list[Message] = []
            while len(found) < depth and (message := _take(subscription)) is not None:
                found.append(message)
            return found

        return news

    def subscribe_raw(self, message_type: InterfaceType, topic: str, heard: Callable[[bytes], None]) -> Any:
        """Call `heard` with each message as it is on the wire, with the QoS of those who publish now."""
        offered = [info.qos_profile for info in self.node.get_publishers_info_by_topic(topic)]
        return self.node.create_subscription(
            message_type, topic, heard, quality.as_offered(offered), callback_group=self.group, raw=True
        )

    def lease_publisher(self, message_type: InterfaceType, topic: str, seconds: float) -> Any:
        """A latched publisher whose readers are told when it was not asserted for `seconds`."""
        return self.node.create_publisher(message_type, topic, quality.lease(seconds))

    def lease_subscribe(
        self,
        message_type: InterfaceType,
        topic: str,
        seconds: float,
        heard: Callable[[Message], None],
        alive: Callable[[int, int], None],
    ) -> Any:
        """Call `heard` with messages and `alive` with the numbers of publishers that are, and are not, asserted.

        A publisher that was killed counts as not asserted until discovery has dropped it.
        """
        events = SubscriptionEventCallbacks(liveliness=lambda event: alive(event.alive_count, event.not_alive_count))
        return self.node.create_subscription(
            message_type, topic, heard, quality.lease(seconds), callback_group=self.group, event_callbacks=events
        )

    def every(self, seconds: float, step: Callable[[], None]) -> Any:
        """Call `step` on the executor thread at a fixed rate."""
        return self.node.create_timer(seconds, step, callback_group=self.group)

    def beside(self, seconds: float, step: Callable[[], None], name: str) -> None:
        """Call `step` at a fixed rate in a thread of its own, for what only samples: it costs a tenth of a timer."""

        def run() -> None:
            while not self.closing:
                try:
                    step()
                except InvalidHandle:  # the node is gone
                    return
                time.sleep(seconds)

        threading.Thread(target=run, name=name, daemon=True).start()

    def after(self, seconds: float, step: Callable[[], None]) -> None:
        """Call `step` on the executor thread once, in a while. On the executor thread only."""

        def once() -> None:
            self.node.destroy_timer(timer)
            step()

        timer = self.every(seconds, once)

    # services

    def offer(
        self,
        service_type: InterfaceType,
        name: str,
        handler: Callable[[Request, Response], Response | Awaitable[Response]],
    ) -> None:
        """Offer a service; the handler runs on the executor thread and must be quick, or be a coroutine function."""
        self._offered(service_type, name, handler)

    def _offered(self, service_type: InterfaceType, name: str, handler: Callable[..., Any]) -> Any:
        service = self.node.create_service(
            service_type, name, handler, qos_profile=quality.SERVICE, callback_group=self.group
        )
        send_surely(service, self.after)
        return service

    def offer_slow(
        self, service_type: InterfaceType, name: str, handler: Callable[[Request, Response], Response | None]
    ) -> Any:
        """Offer a service whose handler may block: each call runs in a thread of its own; None is no answer at all."""

        async def answer(request: Request, response: Response) -> Response:
            done = self.promise()

            def work() -> None:
                filled = _failed(response)
                try:
                    filled = handler(request, service_type.Response())
                finally:  # a bug is logged by the thread; the caller still gets an answer
                    self.on_executor(lambda: done.set_result(filled))

            threading.Thread(target=work, name=name, daemon=True).start()
            return await done

        return self._offered(service_type, name, answer)

    def _service(self, service_type: InterfaceType, name: str) -> Any:
        key = (service_type.__name__, name)
        with self._making:
            if key not in self._clients:
                self._clients[key] = self.node.create_client(
                    service_type, name, qos_profile=quality.SERVICE, callback_group=self.group
                )
            return self._clients[key]

    def prepare(self, service_type: InterfaceType, name: str) -> None:
        """Make the client of a service now, for requests that must not wait for discovery when they count."""
        self._service(service_type, name)

    def call(
        self,
        service_type: InterfaceType,
        name: str,
        request: Request,
        seconds: float = 5.0,
        lost: Callable[[], bool] = lambda: False,
    ) -> Response:
        """Call a service and wait for its answer; from worker threads only.

        `lost` tells of a server that is known to be gone, so that nobody waits for what it will not say any more.

        Raises:
            RosError: NO_SERVER or NO_ANSWER within `seconds`, or LOST.
        """
        assert threading.current_thread() is not self._thread, "blocking call on the executor thread"
        client = self._service(service_type, name)
        deadline = time.monotonic() + seconds
        self.wait_for(client.service_is_ready, seconds, f"service {name} is not there")
        done = threading.Event()
        future = client.call_async(request)
        future.add_done_callback(lambda _: done.set())
        while not done.wait(min(LOOK, max(0.0, deadline - time.monotonic()))):
            if lost() or time.monotonic() >= deadline:
                client.remove_pending_request(future)
                if lost():
                    raise RosError(f"the process behind service {name} was lost before it answered", "LOST")
                raise RosError(f"service {name} did not answer within {seconds:.1f} s", "NO_ANSWER")
        return future.result()

    def has_service(self, service_type: InterfaceType, name: str) -> bool:
        """Whether a service is there now."""
        return bool(self._service(service_type, name).service_is_ready())

    def post(self, service_type: InterfaceType, name: str, request: Request) -> None:
        """Send a service request without waiting for its answer."""
        client = self._service(service_type, name)
        self.on_executor(lambda: client.call_async(request))

    def request(
        self, service_type: InterfaceType, name: str, request: Request, answered: Callable[[Response], None]
    ) -> Callable[[], None] | None:
        """Send a request; `answered` is called on the executor thread, where this must be called, too.

        Returns what forgets the request, or None when the service is not there.
        """
        client = self._service(service_type, name)
        if not client.service_is_ready():
            return None
        future = client.call_async(request)
        future.add_done_callback(lambda done: answered(done.result()))
        return lambda: client.remove_pending_request(future)

    async def ask(self, service_type: InterfaceType, name: str, request: Request, seconds: float) -> Response | None:
        """Call a service from a callback on the executor thread; None when it did not answer in time."""
        client = self._service(service_type, name)
        answer = Future(executor=self._executor)
        deadline = time.monotonic() + seconds
        sent: list[Future] = []

        def look() -> None:
            if not sent and client.service_is_ready():
                sent.append(client.call_async(request))
                sent[0].add_done_callback(lambda future: settle(future.result()))
            elif time.monotonic() >= deadline:
                settle(None)

        def settle(value: Response | None) -> None:
            if not answer.done():
                answer.set_result(value)

        look()
        timer = self.every(seconds if sent else POLL, look)
        try:
            return await answer
        finally:
            self.node.destroy_timer(timer)
            if sent and not sent[0].done():
                client.remove_pending_request(sent[0])

    # actions

    def peer(self, action_type: InterfaceType, name: str) -> Peer:
        """The action server called `name`; one client is kept for all goals."""
        with self._making:
            if name not in self._peers:
                self._peers[name] = Peer(self, action_type, name)
            return self._peers[name]

    def serve(
        self,
        action_type: InterfaceType,
        name: str,
        run: Callable[[Goal], Ended],
        accept: Accept | None = None,
    ) -> None:
        """Serve an action: `run` in a worker thread a goal, `accept` on the executor thread before.

        `run` must return soon after `goal.cancelled` is set. When it raises, the goal is aborted and the
        traceback logged.
        """
        self._served.serve(action_type, name, run, accept)


class _Executor(SingleThreadedExecutor):  # type: ignore[misc]
    """Knows since when it has been in its present callback."""

    busy_since: float | None = None  # monotonic; None while it waits

    def wait_for_ready_callbacks(self, *args: Any, **settings: Any) -> Any:
        self.busy_since = None
        found = super().wait_for_ready_callbacks(*args, **settings)
        self.busy_since = time.monotonic()
        return found


class _Asleep(CallbackGroup):  # type: ignore[misc]
    """Of subscriptions that the executor must not wait for."""

    def can_execute(self, entity: Any) -> bool:
        return False

    def beginning_execution(self, entity: Any) -> bool:
        return False

    def ending_execution(self, entity: Any) -> None:
        raise AssertionError("nothing of this group is executed")


def _failed(response: Response) -> Response:
    """What a caller hears when a handler has a bug."""
    if hasattr(response, "error_code") and isinstance(response.error_code, str):
        response.error_code, response.error_msg = "INTERNAL", "this is a bug: see the log of the process"
    return response


def _take(subscription: Any) -> Message | None:
    """The oldest message that waits."""
    with subscription.handle:
        taken = subscription.handle.take_message(subscription.msg_type, False)
    return None if taken is None else taken[0]


def _unheard(message: Message) -> None:
    raise AssertionError("messages of a sampled topic are taken, not heard")
