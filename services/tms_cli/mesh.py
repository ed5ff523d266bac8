"""Starts and ends the mesh of this PC: checks first, then supervisord."""

import fcntl
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import psutil

from tms_cli import monitoring
from tms_cli.reasons import (
    DomainTaken,
    EndsAgain,
    LittleRoom,
    NotReadyAfter,
    NotStarted,
    PidsLeft,
    PortInUse,
    StateNotWritable,
    SupervisordFailed,
    SupervisordNotUp,
)
from tms_cli.words import say, with_command
from tms_config.clock import monotonic, sleep
from tms_config.config import CHOICE, Site
from tms_config.processes import Process, here
from tms_host import store
from tms_host.supervisor import Supervisor, render, runtime_folder
from tms_reason.errors import ConfigError, TmsError
from tms_reason.reason import Reason
from tms_reason.remedies import ENABLE
from tms_runtime import metrics, state_folder
from tms_runtime.environment import environment
from tms_runtime.priority import session_first
from tms_ur.address import certificate, users

NEEDED_BYTES = 100 * 2**20  # for logs
READY_LIMIT = 60.0  # s for all processes to be ready
ENABLED_LATE = 3.0  # s in which a gateway that starts may still learn which areas are enabled
START_LIMIT = 10.0  # s for supervisord to answer
MESH_END_LIMIT = 20.0  # s for all processes to end
NICE = -10  # of all processes together, against other sessions of this PC, where one command could take half the PC


@dataclass(frozen=True)
class DomainOwner:
    """The mesh that uses a ROS domain on this PC."""

    pid: int
    started: float
    state: str

    def alive(self) -> bool:
        """Whether the same process still runs (the system may have given its pid to another one)."""
        try:
            return abs(psutil.Process(self.pid).create_time() - self.started) < 1.0
        except psutil.NoSuchProcess:
            return False


def check(site: Site) -> tuple[Process, ...]:
    """Check everything that can be checked before a process starts; returns the rows.

    Raises:
        ConfigError: names the first fault and what to do.
    """
    rows = here(site)
    environment(site)
    if any(row.name == "store" for row in rows):  # other PCs of the site do not need it
        store.check(site)
    if any(row.name == "ur" for row in rows):
        certificate(site)
        users(site)
    try:
        state_folder.make(site.state)
        for name in ("log", "ros"):
            (site.state / name).mkdir(mode=0o700, exist_ok=True)
        free = shutil.disk_usage(site.state).free
    except OSError as error:
        raise ConfigError(StateNotWritable(str(site.state), str(error.strerror))) from error
    if free < NEEDED_BYTES:
        raise ConfigError(LittleRoom(str(site.state), free / 2**20))
    return rows


def up(site: Site, foreground: bool = False, without: str = "") -> bool:
    """Start supervisord for this site; False when it already runs. Does not wait for the processes.

    In the foreground this process becomes supervisord, as containers and systemd want it. `without`: a group of the
    process table that the caller runs itself.

    Raises:
        ConfigError, TmsError: a port or the ROS domain is taken, or supervisord does not start.
    """
    rows = tuple(row for row in check(site) if row.group != without)
    if closed := state_folder.tighten(site.state):
        reported = say("{folder}: closed {count} files to other users", folder=site.state, count=closed)
        print(reported, file=sys.stderr)
    monitoring.render(site, monitoring.folder(site), os.environ.get("TMS_ALERTS_TO"))
    with state_folder.private():
        return _up(site, rows, foreground)


def _up(site: Site, rows: tuple[Process, ...], foreground: bool) -> bool:
    if site.pc is not None:
        (site.state / CHOICE).write_text(site.pc, encoding="utf-8")  # for later verbs
    supervisor = Supervisor(site)
    with _domain(site.domain) as lock:
        if supervisor.alive():
            return False
        _refuse_other_mesh(site, lock)
        _refuse_taken_ports(site, rows)
        conf = site.state / "supervisord.conf"
        conf.write_text(render(site, rows), encoding="utf-8")
        if foreground:
            _write(lock, DomainOwner(os.getpid(), psutil.Process().create_time(), str(site.state)))
            _exec_entry(site, conf)
        _start(site, conf)
        _wait(supervisor.alive, START_LIMIT, SupervisordNotUp(f"{site.state}/log/supervisord.log"))
        pid = supervisor.pid()
        session_first(pid, NICE)
        _write(lock, DomainOwner(pid, psutil.Process(pid).create_time(), str(site.state)))
    return True


def down(site: Site) -> bool:
    """Stop every process and supervisord; False when nothing ran.

    Raises:
        TmsError: a process is left.
    """
    supervisor = Supervisor(site)
    if not supervisor.alive():
        return False
    pid = supervisor.pid()
    ours = [psutil.Process(pid), *psutil.Process(pid).children(recursive=True)]
    supervisor.shutdown()
    _, left = psutil.wait_procs(ours, MESH_END_LIMIT)
    for process in left:  # children that supervisord could not end
        process.send_signal(signal.SIGKILL)
    _, left = psutil.wait_procs(left, 2.0)
    if left:
        raise TmsError(PidsLeft(tuple(process.pid for process in left), f"{site.state}/log"))
    return True


def _start(site: Site, conf: Path) -> None:
    words = [sys.executable, "-m", "tms_host.prefork", "-c", str(conf)]
    done = subprocess.run(
        words, env={**os.environ, **environment(site)}, capture_output=True, text=True, timeout=30, check=False
    )
    if done.returncode != 0:
        detail = (done.stderr.strip() or done.stdout.strip()).splitlines()
        raise TmsError(SupervisordFailed(detail[-1] if detail else ""))


def _exec_entry(site: Site, conf: Path) -> None:
    """Become supervisord; does not return. exec frees the lock of the domain, since it closes the file."""
    words = [sys.executable, "-m", "tms_host.prefork", "--nodaemon", "-c", str(conf)]
    sys.stdout.flush()
    sys.stderr.flush()
    os.execve(sys.executable, words, {**os.environ, **environment(site)})


def _refuse_other_mesh(site: Site, lock: Path) -> None:
    owner = _read(lock)
    if owner is not None and owner.alive() and owner.state != str(site.state):
        raise ConfigError(DomainTaken(site.domain, owner.pid, owner.state))


def _refuse_taken_ports(site: Site, rows: tuple[Process, ...]) -> None:
    wanted = {row.port: (row.address, f"metrics of {row.full}") for row in rows if row.ours}
    here_too = {row.name for row in rows}
    if "ur" in here_too:
        wanted[site.file.ports.console] = (site.file.bind, "console")
    if "store" in here_too:
        wanted[site.file.ports.store] = ("127.0.0.1", "embedded store")
    for port, (address, purpose) in wanted.items():
        with socket.socket() as probe:
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            try:
                probe.bind((address, port))
            except OSError as error:
                taken = PortInUse(port, purpose, _holder(port), str(site.path), str(error.strerror))
                raise ConfigError(taken) from error


def _holder(port: int) -> str:
    """The process that listens on a port, as far as this user may see it."""
    for connection in psutil.net_connections("tcp"):
        if connection.status == psutil.CONN_LISTEN and connection.laddr[1:] == (port,) and connection.pid:
            process = psutil.Process(connection.pid)
            return f"{process.name()} (pid {connection.pid}, in {process.cwd()})"
    return "another program"


@contextmanager
def _domain(domain: int) -> Iterator[Path]:
    """Exclusive use of the note that says which mesh has a ROS domain on this PC."""
    path = runtime_folder() / f"domain-{domain}.json"
    with path.with_suffix(".lock").open("w") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield path


def _read(path: Path) -> DomainOwner | None:
    try:
        return DomainOwner(**json.loads(path.read_text()))
    except (FileNotFoundError, ValueError, TypeError):
        return None  # no note, or one cut short by a crash: the domain has no owner


def _write(path: Path, owner: DomainOwner) -> None:
    path.write_text(json.dumps(owner.__dict__))


def _wait(holds: Callable[[], bool], seconds: float, otherwise: Reason) -> None:
    deadline = monotonic() + seconds
    while not holds():
        if monotonic() > deadline:
            raise TmsError(otherwise)
        sleep(0.05)


def wait_ready(site: Site, report: Callable[[str], None]) -> None:
    """Wait until every process that starts by itself is ready; `report` gets one line per process.

    Those that wait for areas that nobody has enabled are told and left: for that, the mesh must run.

    Raises:
        TmsError: names the first process that did not get ready, why, and where its log is.
    """
    waiting = {row.full: row for row in here(site) if row.autostart and row.ours}
    deadline = monotonic() + READY_LIMIT
    reasons: dict[str, Reason] = {}
    others = monotonic()  # when a process last waited for something else
    while waiting:
        for name, row in list(waiting.items()):
            reason = metrics.unready(row)
            if reason is None:
                del waiting[name]
                report(say("{name} ready", name=name))
            else:
                reasons[name] = reason
        if any(reasons[name].remedy != ENABLE for name in waiting):
            others = monotonic()
        elif monotonic() - others > ENABLED_LATE:
            for name in waiting:
                report(say("{name} waits: {why}", name=name, why=with_command(reasons[name])))
            return
        if waiting and monotonic() > deadline:
            name = min(waiting, key=lambda name: reasons[name].remedy == ENABLE)
            raise TmsError(NotReadyAfter(name, READY_LIMIT, reasons[name]))
        sleep(0.1)


def wait_running(site: Site, name: str) -> None:
    """Wait until supervisord calls a process RUNNING.

    Raises:
        TmsError: it is FATAL or took too long; says where its log is.
    """

    def state() -> str:
        return next((row.state for row in supervisor.processes() if row.name == name), "UNKNOWN")

    supervisor = Supervisor(site)
    _wait(lambda: state() in ("RUNNING", "FATAL"), START_LIMIT, NotStarted(name))
    if state() == "FATAL":
        raise TmsError(EndsAgain(name))
