"""Process `tms:ur`: the HTTP API and the console, for people and programs."""

import socket
import threading

import uvicorn

from tms_core.app import App
from tms_core.config import Site
from tms_core.errors import ConfigError
from tms_core.site_file import Files, SiteFile
from tms_ur import address
from tms_ur.access import Access
from tms_ur.api import create_app
from tms_ur.audit import Audit
from tms_ur.gateway import Gateway
from tms_ur.guard import is_loopback

STOP_LIMIT = 0.8  # s for open requests to end; the runtime ends the process within 2


def start(app: App) -> None:
    """Listen on the console's port of the site file."""
    file = app.site.file
    tls = address.certificate(app.site)
    access = Access(address.users(app.site))
    listener = _listen(app.site)
    gateway, audit = Gateway(app.ros, app.site), Audit(app.ros)
    server = Server(create_app(gateway, audit, app.site, access), listener, tls)
    app.on_stop(audit.close)
    app.on_stop(server.stop)
    app.on_stop(gateway.board.close)  # first, so that the streams end
    app.ready_when(server.unready)
    app.log.info("event=listening url=%s bind=%s access=%r", address.url(file), file.bind, _told(file, access))


def _told(file: SiteFile, access: Access) -> str:
    """Who may do what, for the log."""
    if access.asks:
        return "users of console.users" + (
            "" if file.console.tls else ", passwords travel in the clear: set console.tls"
        )
    return "everybody at this PC" if is_loopback(file.bind) else "everybody may look, nobody may command: no users"


class Server:
    """uvicorn in a thread of its own; signals stay with the runtime."""

    def __init__(self, application: object, listener: socket.socket, tls: Files | None) -> None:
        config = uvicorn.Config(
            application,  # type: ignore[arg-type]  # FastAPI's own types differ from uvicorn's
            log_config=None, log_level="warning", access_log=False, http="h11", ws="none", loop="asyncio",
            lifespan="on", server_header=False, proxy_headers=False, limit_concurrency=200, timeout_keep_alive=30,
            ssl_certfile=tls.certificate if tls else None, ssl_keyfile=tls.key if tls else None,
        )  # fmt: skip
        self._server = uvicorn.Server(config)
        self._thread = threading.Thread(target=self._server.run, args=([listener],), name="http", daemon=True)
        self._thread.start()

    def unready(self) -> str | None:
        """Why nobody is answered."""
        if not self._thread.is_alive():
            return "the web server has ended: see `tms logs tms:ur`"
        return None if self._server.started else "the web server is not up yet"

    def stop(self) -> None:
        """Let open requests end for a moment, then leave them."""
        self._server.should_exit = True
        self._thread.join(STOP_LIMIT)
        self._server.force_exit = True
        self._thread.join(0.2)


def _listen(site: Site) -> socket.socket:
    bind, port = site.file.bind, site.file.ports.console
    try:
        return socket.create_server((bind, port), family=socket.AF_INET6 if ":" in bind else socket.AF_INET)
    except OSError as error:
        raise ConfigError(
            f"{site.path}: cannot listen on port {port} of {bind} ({error.strerror}): stop the program "
            "that uses it, or change ports.console or bind"
        ) from error
