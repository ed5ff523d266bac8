"""Process `tms:ur`: the HTTP API and the console, for people and programs."""

import socket

from tms_config.config import Site
from tms_config.site_file import SiteFile
from tms_reason.errors import ConfigError
from tms_runtime.app import App
from tms_ur import address
from tms_ur.access import Access
from tms_ur.acts import Acts
from tms_ur.api import create_app
from tms_ur.audit import Audit
from tms_ur.buttons import Buttons
from tms_ur.connections import SENT, Listener
from tms_ur.reasons import CannotListen
from tms_ur.security import is_loopback
from tms_ur.server import Server
from tms_ur.site_client import SiteClient


def start(app: App) -> None:
    """Serve the console on the port of the site file."""
    file = app.site.file
    tls = address.certificate(app.site)
    access = Access(address.users(app.site))
    listener = _listen(app.site)
    client, audit = SiteClient(app.ros, app.site), Audit(app.ros, app.site.state / "audit.db")
    Acts(app.ros, audit, app.site.state / "audit.acts", list(file.machines))
    if app.site.file.console.buttons:
        Buttons(app.ros, client, audit, app.site.file.console.buttons)
    server = Server(create_app(client, audit, app.site, access), listener, tls)
    app.on_stop(audit.close)
    app.on_stop(server.stop)
    app.on_stop(client.board.close)  # first, so that the streams end
    app.ready_when(server.unready)
    app.log.info("listening", url=address.url(file), bind=file.bind, access=_who_may(file, access))


def _who_may(file: SiteFile, access: Access) -> str:
    """Who may use the console, for the log."""
    if access.asks:
        return "users of console.users" + (
            "" if file.console.tls else ", passwords travel in the clear: set console.tls"
        )
    return "all at this PC" if is_loopback(file.bind) else "all may look, none may command: no users"


def _listen(site: Site) -> Listener:
    bind, port = site.file.bind, site.file.ports.console
    try:
        made = socket.create_server((bind, port), family=socket.AF_INET6 if ":" in bind else socket.AF_INET)
        made.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, SENT)  # accepted connections inherit it
        return Listener(fileno=made.detach())
    except OSError as error:
        raise ConfigError(CannotListen(str(site.path), port, bind, str(error.strerror))) from error
