"""supervisord: its configuration from the process table, and its RPC over a unix socket of mode 0600."""

import hashlib
import os
import sys
import tempfile
import xmlrpc.client
from dataclasses import dataclass
from pathlib import Path

from supervisor.xmlrpc import SupervisorTransport

from tms_config.clock import monotonic, sleep
from tms_config.config import PROJECT, Site
from tms_config.processes import Process, here
from tms_host.reasons import (
    LogUnreadable,
    MeshDown,
    NoProcessHere,
    NotEnded,
    NotPrivate,
    PathQuoted,
    SupervisordSays,
)
from tms_reason.errors import ConfigError, TmsError
from tms_runtime.environment import environment
from tms_runtime.state_folder import UMASK

AT_ONCE = 1  # priority of programs that start while the libraries of ours are loaded, see prefork.py; else 999
START_SECONDS = 1  # a process that ends sooner counts as failed to start
STOP_SECONDS = 3  # the runtime ends within 2
END_LIMIT = STOP_SECONDS + 1.0  # s; supervisord kills after STOP_SECONDS
END_CHECK_PERIOD = 0.1  # s between checks of a process that is being stopped
LOG_SIZE, LOG_FILES = "10MB", 3


class SupervisorDown(TmsError):
    """supervisord does not run or does not answer."""


@dataclass(frozen=True)
class Running:
    """A process as supervisord sees it."""

    name: str  # group:name
    state: str
    pid: int
    uptime: float  # s
    detail: str


def runtime_folder() -> Path:
    """Private folder for sockets and locks: unix socket paths may hold 107 characters at most.

    Raises:
        ConfigError: another user owns it.
    """
    base = Path(os.environ.get("XDG_RUNTIME_DIR") or tempfile.gettempdir())
    folder = base / f"tms-{os.getuid()}"
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    facts = folder.stat()
    if facts.st_uid != os.getuid() or facts.st_mode & 0o077:
        raise ConfigError(NotPrivate(str(folder)))
    return folder


def socket_path(site: Site) -> Path:
    """Supervisord's socket for the mesh whose state is in `site.state`."""
    return runtime_folder() / f"{hashlib.sha256(str(site.state).encode()).hexdigest()[:16]}.sock"


def render(site: Site, rows: tuple[Process, ...] | None = None) -> str:
    """The text of supervisord.conf for these rows (default: those of this PC)."""
    rows = here(site) if rows is None else rows
    parts = [_daemon(site), *(_program(site, row) for row in rows)]
    for group in dict.fromkeys(row.group for row in rows):
        members = [row for row in rows if row.group == group]
        names, first = ",".join(map(_section, members)), min(map(_priority, members))
        parts.append(f"[group:{group}]\nprograms={names}\npriority={first}\n")
    return "\n".join(parts)


def _daemon(site: Site) -> str:
    words = ",".join(f'{key}="{_escape(value)}"' for key, value in environment(site).items())
    folder = _escape(str(site.state))
    return f"""[supervisord]
logfile={folder}/log/supervisord.log
logfile_maxbytes={LOG_SIZE}
logfile_backups={LOG_FILES}
pidfile={folder}/supervisord.pid
childlogdir={folder}/log
identifier=tms-{site.name}
umask={UMASK:03o}
directory={_escape(str(PROJECT))}
environment={words}
strip_ansi=true

[unix_http_server]
file={_escape(str(socket_path(site)))}
chmod=0600

[rpcinterface:supervisor]
supervisor.rpcinterface_factory=supervisor.rpcinterface:make_main_rpcinterface
"""


def _program(site: Site, row: Process) -> str:
    log = _escape(str(log_file(site, row.full)))
    return f"""[program:{_section(row)}]
process_name={row.name}
command="{_escape(sys.executable)}" -m tms_runtime.run {row.full}
autostart={str(row.autostart).lower()}
autorestart=true
priority={_priority(row)}
startsecs={START_SECONDS}
startretries=3
stopsignal=TERM
stopwaitsecs={STOP_SECONDS}
stopasgroup=false
killasgroup=true
stdout_logfile={log}
stdout_logfile_maxbytes={LOG_SIZE}
stdout_logfile_backups={LOG_FILES}
redirect_stderr=true
"""


def log_file(site: Site, name: str) -> Path:
    """The file of a process's output."""
    group, _, process = name.partition(":")
    return site.state / "log" / f"{group}.{process}.log"


def _section(row: Process) -> str:
    return f"{row.group}.{row.name}"


def _priority(row: Process) -> int:
    return 999 if row.ours else AT_ONCE


def _escape(text: str) -> str:
    """Escape a value: supervisord expands %(name)s in it."""
    if '"' in text or "\n" in text:
        raise ConfigError(PathQuoted(repr(text)))
    return text.replace("%", "%%")


class Supervisor:
    """Calls the supervisord of a site. Not thread safe: each thread needs its own object."""

    def __init__(self, site: Site) -> None:
        self._site, self._path = site, socket_path(site)
        self._proxy = self._connect()

    def _connect(self) -> xmlrpc.client.ServerProxy:
        transport = SupervisorTransport(None, None, f"unix://{self._path}")
        return xmlrpc.client.ServerProxy("http://127.0.0.1", transport=transport)

    def _call(self, method: str, *words: object) -> object:
        try:
            return getattr(self._proxy.supervisor, method)(*words)
        except xmlrpc.client.Fault as fault:
            raise TmsError(SupervisordSays(fault.faultString, f"{method}{words}")) from fault
        except (OSError, xmlrpc.client.ProtocolError) as error:
            self._proxy("close")()
            self._proxy = self._connect()  # the old proxy's broken connection cannot be used again
            raise SupervisorDown(MeshDown()) from error

    def close(self) -> None:
        """Close the connection."""
        self._proxy("close")()

    def alive(self) -> bool:
        """Whether supervisord answers."""
        try:
            self._call("getState")
        except SupervisorDown:
            return False
        return True

    def pid(self) -> int:
        """Supervisord's own pid."""
        pid = self._call("getPID")
        assert isinstance(pid, int)
        return pid

    def processes(self) -> list[Running]:
        """All processes of this PC."""
        rows = self._call("getAllProcessInfo")
        assert isinstance(rows, list)
        return [_running(row) for row in rows]

    def process(self, name: str) -> Running:
        """One process of this PC.

        Raises:
            TmsError: there is none of this name.
        """
        for row in self.processes():
            if row.name == name:
                return row
        raise TmsError(NoProcessHere(name), "NO_PROCESS")

    def control(self, command: str, name: str) -> None:
        """Start, stop or restart one process; that it already runs or stands is no error.

        Raises:
            TmsError: it cannot be started; the message says where its log is.
        """
        state = self._settled(name)
        up = state in ("RUNNING", "STARTING")
        again = state == "BACKOFF"  # it has ended early and is about to be started again: stopping ends that
        if again or (up and command in ("stop", "restart")):
            self._call("stopProcess", name, True)
        if command in ("start", "restart") and not (command == "start" and up):
            self._call("startProcess", name, False)

    def _settled(self, name: str) -> str:
        """State of a process once it is not being stopped any more.

        Until then, supervisord accepts a start without starting it.

        Raises:
            TmsError: there is no such process, or it does not end.
        """
        deadline = monotonic() + END_LIMIT
        while (state := self.process(name).state) == "STOPPING":
            if monotonic() > deadline:
                raise TmsError(NotEnded(name, END_LIMIT))
            sleep(END_CHECK_PERIOD)
        return state

    def log(self, name: str, size: int) -> str:
        """Whole lines from the end of a process's log, `size` bytes at most.

        They are read from the file: supervisord fails if a piece of it begins within a character.

        Raises:
            TmsError: there is no such process, or it has no log yet.
        """
        path = log_file(self._site, self.process(name).name)
        try:
            with path.open("rb") as file:
                begin = max(0, file.seek(0, os.SEEK_END) - size)
                file.seek(begin)
                data = file.read(size)
        except OSError as error:
            raise TmsError(LogUnreadable(name, str(error.strerror), str(path))) from error
        begun = data.find(b"\n") + 1 if begin else 0
        return data[begun:].decode(errors="replace")

    def shutdown(self) -> None:
        """Stop all processes at once (groups one after another take three times as long), then supervisord."""
        self._call("stopAllProcesses", True)
        self._call("shutdown")


def _running(row: dict[str, object]) -> Running:
    uptime = float(str(row["now"])) - float(str(row["start"])) if row["statename"] == "RUNNING" else 0.0
    name = f"{row['group']}:{row['name']}"
    return Running(name, str(row["statename"]), int(str(row["pid"])), uptime, str(row["description"]))
