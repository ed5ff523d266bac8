"""Services: served, called from threads, and called from callbacks."""

import threading
from collections.abc import Awaitable, Callable
from typing import Any

from rclpy.exceptions import NameValidationException

from tms_config.clock import monotonic
from tms_config.naming import process_of
from tms_decision.reasons import ProcessLost
from tms_interfaces.generated import Req, Res, ServiceType
from tms_reason.errors import RosError
from tms_reason.wire import to_line
from tms_ros import quality
from tms_ros.loop import POLL, EventLoop
from tms_ros.privates import send_surely
from tms_ros.reasons import BadServiceName, Internal, LostMeanwhile, NoAnswer, NoServer

SERVER_CHECK_PERIOD = 0.1  # s between checks whether a server that must still answer exists


class Services:
    """The services that a node serves and calls."""

    def __init__(self, loop: EventLoop) -> None:
        self._loop = loop
        self._clients: dict[tuple[Any, str], Any] = {}  # by type and name
        self._making = threading.Lock()

    def offer(
        self, service_type: ServiceType[Req, Res], name: str, handler: Callable[[Req, Res], Res | Awaitable[Res]]
    ) -> Any:
        """Serve a service; the handler runs on the executor thread and must be quick, or be a coroutine function."""
        service = self._loop.node.create_service(
            service_type, name, handler, qos_profile=quality.SERVICE, callback_group=self._loop.group
        )
        send_surely(service, self._loop.after)
        return service

    def offer_slow(
        self, service_type: ServiceType[Req, Res], name: str, handler: Callable[[Req, Res], Res | None]
    ) -> Any:
        """Serve a service whose handler may block: each call has a thread; None sends no answer."""

        def work(request: Req, send: Callable[[Res | None], None]) -> None:
            filled: Res | None = _failed(service_type.Response(), self._loop.process)
            try:
                filled = handler(request, service_type.Response())
            finally:  # a bug is logged by the thread; the caller still gets an answer
                self._loop.on_executor(lambda: send(filled))

        def answer(request: Req, _: Res) -> Any:
            return lambda send: self._loop.in_thread(lambda: work(request, send))

        return self.offer(service_type, name, answer)

    def prepare(self, service_type: ServiceType[Req, Res], name: str) -> Any:
        """The client of a service. Made early, a later urgent request need not wait for discovery."""
        key = (service_type, name)
        with self._making:
            if key not in self._clients:
                try:
                    self._clients[key] = self._loop.node.create_client(
                        service_type, name, qos_profile=quality.SERVICE, callback_group=self._loop.group
                    )
                except NameValidationException as error:
                    raise RosError(BadServiceName(name, str(error).partition("\n")[0])) from error
            return self._clients[key]

    def call(
        self,
        service_type: ServiceType[Req, Res],
        name: str,
        request: Req,
        seconds: float = 5.0,
        lost: Callable[[], bool] = lambda: False,
    ) -> Res:
        """Call a service and wait for its answer; from worker threads only.

        `lost` returns whether the server is known to be gone, so that the caller does not wait for its answer.

        Raises:
            RosError: NoServer or NoAnswer within `seconds`, or ProcessLost.
        """
        assert not self._loop.is_current(), "blocking call on the executor thread"
        client, deadline = self.prepare(service_type, name), monotonic() + seconds
        self._loop.wait_for(client.service_is_ready, seconds, NoServer(process_of(name), name, seconds))
        done = threading.Event()
        future = client.call_async(request)
        future.add_done_callback(lambda _: done.set())
        self._loop.on_executor(lambda: None)  # so that it waits for this answer, too
        while not done.wait(min(SERVER_CHECK_PERIOD, max(0.0, deadline - monotonic()))):
            if lost() or monotonic() >= deadline:
                client.remove_pending_request(future)
                if lost():
                    raise RosError(ProcessLost(LostMeanwhile(process_of(name), name)))
                raise RosError(NoAnswer(process_of(name), name, seconds))
        answer: Res = future.result()
        return answer

    def has_service(self, service_type: ServiceType[Req, Res], name: str) -> bool:
        """Whether a service exists now."""
        return bool(self.prepare(service_type, name).service_is_ready())

    def call_unanswered(self, service_type: ServiceType[Req, Res], name: str, request: Req) -> None:
        """Send a service request without waiting for its answer, which may never come."""
        client = self.prepare(service_type, name)
        self._loop.on_executor(lambda: client.remove_pending_request(client.call_async(request)))

    def call_then(
        self, service_type: ServiceType[Req, Res], name: str, request: Req, answered: Callable[[Res], None]
    ) -> Callable[[], None] | None:
        """`call_now`, or None when the service does not exist."""
        return self.call_now(service_type, name, request, answered) if self.has_service(service_type, name) else None

    def call_now(
        self, service_type: ServiceType[Req, Res], name: str, request: Req, answered: Callable[[Res], None]
    ) -> Callable[[], None]:
        """Send a request, whether its service exists or not: rmw looks through the whole graph for that.

        `answered` is called on the executor thread. Returns how to drop the request.
        """
        client = self.prepare(service_type, name)
        future = client.call_async(request)
        future.add_done_callback(lambda done: answered(done.result()))
        self._loop.on_executor(lambda: None)  # so that it waits for this answer, too
        return lambda: client.remove_pending_request(future)

    async def call_async(
        self, service_type: ServiceType[Req, Res], name: str, request: Req, seconds: float
    ) -> Res | None:
        """Call a service from a callback on the executor thread; None when it did not answer in time.

        Raises:
            RosError: BadServiceName.
        """
        client, deadline = self.prepare(service_type, name), monotonic() + seconds
        while not client.service_is_ready():
            if monotonic() >= deadline:
                return None
            await self._loop.pause(POLL)
        answer = client.call_async(request)
        timer = self._loop.every(max(POLL, deadline - monotonic()), lambda: answer.done() or answer.set_result(None))
        try:
            found: Res | None = await answer
            return found
        finally:
            self._loop.node.destroy_timer(timer)


def _failed(response: Any, process: str) -> Any:
    """The answer to a caller when a handler has raised."""
    if hasattr(response, "error_code") and isinstance(response.error_code, str):
        bug = Internal(process)
        response.error_code, response.error_msg = bug.code, to_line(bug)
    return response
