"""`python -m tms_runtime.run <group:name>`: the one entry of every process."""

import ctypes
import importlib
import os
import platform
import signal
import sys
import threading
from contextlib import ExitStack
from typing import TYPE_CHECKING

from tms_config.clock import monotonic
from tms_config.config import Site, load_site
from tms_config.processes import Process, find
from tms_reason import wire
from tms_reason.errors import ConfigError
from tms_runtime import environment, log, metrics, state_folder, wire_form
from tms_runtime.last_resort import LEAVE_LIMIT, end_after
from tms_runtime.log import Logger
from tms_runtime.metrics import Health
from tms_runtime.priority import come_first, threads, undisturbed
from tms_runtime.reasons import LongCallback, ParentGone, PcBusy, ProcessStarting
from tms_runtime.version import version

if TYPE_CHECKING:
    from tms_ros.node import Ros
    from tms_runtime.app import App

END_CHECK_PERIOD = 0.5  # s
FORGOTTEN = 3.0  # s; lease of discovery (5 s) less the age of the last announcement (1.75 s at most), 0.25 s to spare
EXIT_LIMIT = 2.0  # s from SIGTERM to the end, even if the clean-up hangs
PR_SET_PDEATHSIG = 1
# Nice and real-time priority of processes that must not miss a beat on a busy PC, once they have started: twenty that
# start must not keep working ones from their beats, though each makes its participant with real-time priority 1. A
# stand-in is a machine, which no PC can keep from its motions; the bridge carries what a simulated machine tells. The
# ground must not fall behind machines: who needs a load waits for it. The console sends stops, though it has no beat.
FIRST = {"tms_ts.node": (-15, 2), "tms_rc.node": (-12, 3), "tms_host.node": (-12, 3), "tms_sim.node": (-12, 3),
         "tms_mc.node": (-12, 3), "tms_if.node": (-12, 3), "tms_ground.node": (-5, 0),
         "tms_ur.node": (-5, 1)}  # fmt: skip
OF_A_MACHINE = (-5, 1)  # planner and subtasks, whose permits lapse as well
STARTING = -5  # nice of all these while they start


def main(name: str) -> int:
    """Run one process of the table until SIGTERM or SIGINT; 0 on a clean end."""
    with ExitStack() as leaving:
        try:
            _die_with_parent()
            sys.setswitchinterval(0.001)  # s; of 5 ms each, twenty runs at work keep a beat waiting for 0.1 s
            os.umask(state_folder.UMASK)
            site = load_site()
            row = find(site, name)
            if not row.ours:
                importlib.import_module(row.module).exec_program(site)
            if row.form:
                wire_form.enter(row.form)
            environment.enter(site, tells_few=row.machine is not None)
            return _serve(site, row, leaving)
        except ConfigError as error:
            print(f"{name}: {error}", file=sys.stderr)
            return 1
        finally:
            log.close()


def _serve(site: Site, row: Process, leaving: ExitStack) -> int:
    metrics.BUILD.info({"version": version(), "python": platform.python_version()})
    from tms_ros.node import Ros
    from tms_runtime.app import App  # rclpy reads the environment when it is imported first
    from tms_runtime.graph import Graph

    logger = log.setup(row.full, row.machine, level=site.file.log.level, as_json=site.file.log.json_lines)
    app_box: list[App] = []
    health = Health(
        row.address,
        row.port,
        unready=lambda: app_box[0].unready() if app_box else ProcessStarting(),
        hangs=lambda: app_box[0].hanging.check() if app_box else None,
    )
    stop = threading.Event()
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda _number, _frame: stop.set())
    if row.module in FIRST:
        come_first(STARTING, threads())
    wire.load()  # now: the executor would stand still when it receives the first reason of another service
    ros = Ros(row.full.replace(":", "_"), process=row.full, creating=undisturbed())
    leaving.callback(_leave_unstarted, ros)
    app = App(site, row, ros, logger)
    app.pulse.stood_still = lambda silent, waited: _stood_still(logger, silent, waited)
    importlib.import_module(row.module).start(app)
    leaving.pop_all()
    app_box.append(app)
    Graph(ros, logger)
    if row.module in FIRST or row.group == row.machine:
        nice, realtime = FIRST.get(row.module, OF_A_MACHINE)
        for _ in range(2):  # again for those that these have made meanwhile, and that may wait for work for ever
            come_first(nice, threads(), realtime)
    logger.info("started", pid=os.getpid())
    _wait_for_end(stop, ros.failed, logger)
    return _end(app, health, logger)


def _end(app: "App", health: Health, logger: Logger) -> int:
    end_after(EXIT_LIMIT, 1)
    app.stop()
    app.ros.stop()
    health.close()
    logger.info("stopped")
    log.close()
    code = 1 if app.ros.failed.is_set() else 0
    end_after(LEAVE_LIMIT, code)
    app.ros.leave()
    return code


def _leave_unstarted(ros: "Ros") -> None:
    """Leave the graph before Python ends: it aborts when a thread is in rclpy then."""
    end_after(EXIT_LIMIT, 1)
    ros.stop()
    ros.leave()


def _stood_still(logger: Logger, silent: float, waited: float) -> None:
    """Log why other processes may have taken this one for lost."""
    metrics.STOOD_STILL.inc(silent)
    reason = PcBusy(waited) if waited > silent / 2 else LongCallback(silent)
    logger.warning("stood_still", seconds=round(silent, 2), waited=round(waited, 2), reason=reason)


def _wait_for_end(stop: threading.Event, failed: threading.Event, logger: Logger) -> None:
    """Wait until the process is asked to end, or has failed.

    A process that stood still for long has failed: others may have dropped it from discovery, and two processes of
    which one has dropped the other may stay disconnected for ever. All processes discover its successor.
    """
    before = monotonic()
    while not stop.wait(END_CHECK_PERIOD) and not failed.is_set():
        before, gap = monotonic(), monotonic() - before
        if gap > FORGOTTEN:  # it may have begun just after a check, or just before the next
            logger.error("forgotten", seconds=round(gap, 1), action="restarted")
            failed.set()


def _die_with_parent() -> None:
    """End with supervisord: after its `kill -9`, no orphan may run along with the processes of the next one."""
    parent = os.getppid()
    ctypes.CDLL(None, use_errno=True).prctl(PR_SET_PDEATHSIG, signal.SIGTERM, 0, 0, 0)
    if os.getppid() != parent:
        raise ConfigError(ParentGone())


if __name__ == "__main__":
    if len(sys.argv) != 2:
        print(
            "usage: python -m tms_runtime.run <group:name>, for example zx200:rc; `tms ps` lists them", file=sys.stderr
        )
        sys.exit(2)
    sys.exit(main(sys.argv[1]))
