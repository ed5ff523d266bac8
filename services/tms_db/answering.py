"""Serves the services of tms:db: every call is counted and timed, and an error becomes code and text."""

from collections.abc import Awaitable, Callable

from prometheus_client import Counter, Histogram

from tms_config.clock import monotonic
from tms_db.connection import StoreConnection
from tms_interfaces.generated import Coded, Reply, Req, ServiceType
from tms_reason.errors import TmsError
from tms_reason.wire import to_line
from tms_runtime.app import App

REQUESTS = Counter("tms_db_requests", "Requests answered", ["service", "code"])
SECONDS = Histogram("tms_db_request_seconds", "Time from request to answer", ["service"])

Handler = Callable[[Req, Reply], None]
LaterHandler = Callable[[Req, Reply], Awaitable[None]]


class Answering:
    """Serves handlers as services below /tms/db/."""

    def __init__(self, app: App, connection: StoreConnection) -> None:
        self._app, self._connection = app, connection

    def quick(self, service_type: ServiceType[Req, Reply], name: str, handler: Handler[Req, Reply]) -> None:
        """Serve a handler for one document, about a millisecond; the executor thread keeps the order of the calls."""
        self._app.ros.offer(service_type, f"/tms/db/{name}", self._guard(name, handler))

    def slow(self, service_type: ServiceType[Req, Reply], name: str, handler: Handler[Req, Reply]) -> None:
        """Serve a handler that may block; each call has a thread of its own."""
        self._app.ros.offer_slow(service_type, f"/tms/db/{name}", self._guard(name, handler))

    def later(self, service_type: ServiceType[Req, Reply], name: str, handler: LaterHandler[Req, Reply]) -> None:
        """Serve a coroutine on the executor thread: calls begin in order, and others are served while one waits."""

        async def answer(request: Req, response: Reply) -> Reply:
            begin = monotonic()
            try:
                with self._connection.use():
                    await handler(request, response)
            except TmsError as error:
                self._refused(name, response, error)
            self._count(name, response, begin)
            return response

        self._app.ros.offer(service_type, f"/tms/db/{name}", answer)

    def _guard(self, name: str, handler: Handler[Req, Reply]) -> Callable[[Req, Reply], Reply]:
        def answer(request: Req, response: Reply) -> Reply:
            begin = monotonic()
            try:
                with self._connection.use():
                    handler(request, response)
            except TmsError as error:
                self._refused(name, response, error)
            self._count(name, response, begin)
            return response

        return answer

    def _refused(self, name: str, response: Coded, error: TmsError) -> None:
        response.error_code, response.error_msg = error.code, to_line(error.reason)
        self._app.log.info("refused", service=name, code=error.code, reason=error.reason)

    @staticmethod
    def _count(name: str, response: Coded, begin: float) -> None:
        REQUESTS.labels(name, response.error_code or "OK").inc()
        SECONDS.labels(name).observe(monotonic() - begin)
