"""Process `tms:if`: the ROS-TCP endpoint that OperaSim-PhysX connects to; no other ROS installation is needed."""

import socket
import threading

from tms_if.client import Client
from tms_if.client_endpoints import ClientEndpoints
from tms_if.names import allowed
from tms_if.reasons import InterfacePortTaken
from tms_reason.errors import ConfigError
from tms_runtime.app import App

MAX_CLIENTS = 16  # clients at a time
PAUSE = 1.0  # s after the system could not accept a connection


def start(app: App) -> None:
    """Listen for connections of simulators."""
    settings = app.site.bridge
    try:
        server = socket.create_server((settings.bind, settings.port), backlog=MAX_CLIENTS)
    except OSError as error:
        raise ConfigError(InterfacePortTaken(f"{settings.bind}:{settings.port}", str(error.strerror))) from error
    bridge = Endpoint(app, server)
    threading.Thread(target=bridge.accept, name="accept", daemon=True).start()
    app.on_stop(bridge.close)
    app.ready_when(lambda: None)
    app.log.info("listening", address=f"{settings.bind}:{settings.port}", joint_cmd=settings.joint_cmd)


class Endpoint:
    """Accepts connections; each has ROS endpoints of its own, and no two publish one topic."""

    def __init__(self, app: App, server: socket.socket) -> None:
        self._app, self._server = app, server
        self._allowed = allowed(app.site)
        self._speakers: dict[str, str] = {}  # topic -> the client that publishes it
        self._clients: set[Client] = set()

    def accept(self) -> None:
        """Accept connections until the process stops."""
        while not self._app.stopping.is_set():
            try:
                connection, (host, port, *_) = self._server.accept()
            except OSError as error:
                if not self._app.stopping.is_set():
                    self._app.log.error("not_accepted", reason=error.strerror)
                    self._app.stopping.wait(PAUSE)
                continue
            if len(self._clients) >= MAX_CLIENTS:
                self._app.log.warning(
                    "client_refused", client=f"{host}:{port}", reason="too many others", others=MAX_CLIENTS
                )
                connection.close()
                continue
            threading.Thread(
                target=self._serve, args=(connection, f"{host}:{port}"), name="client", daemon=True
            ).start()

    def close(self) -> None:
        """End all connections."""
        self._server.close()
        for client in list(self._clients):
            client.close("the bridge stops")

    def _serve(self, connection: socket.socket, name: str) -> None:
        settings = self._app.site.bridge
        client = Client(
            connection, name, self._app.log, settings.message_limit,
            lambda send, say: ClientEndpoints(
                self._app.ros, settings.joint_cmd, self._allowed, self._speakers, name, send, say
            ),
        )  # fmt: skip
        self._clients.add(client)
        try:
            client.run()
        finally:
            self._clients.discard(client)
