"""Runs the stand-ins as children of the drill: they represent machines, which a power cut of our PC does not stop."""

import os
import subprocess
import sys
from pathlib import Path
from types import TracebackType

from tms_cli.drill.operasim import OperaSim
from tms_config.config import Site
from tms_config.processes import table
from tms_runtime import state_folder
from tms_runtime.environment import environment
from tms_runtime.priority import come_first, session_first

GROUP = "sim"  # group of the stand-ins in the process table
SIMULATOR = "operasim"  # stands for all machines of a site
END_LIMIT = 5.0  # s
NICE = -15  # above the gateways, since a machine does not wait for them


class StandIns:
    """Starts the stand-ins from the main thread; they end with it, whatever ends it."""

    def __init__(self, site: Site) -> None:
        names = [row.name for row in table(site) if row.group == GROUP]
        self._children = [self._start(site, name) for name in names]
        self.operasim = OperaSim(_log_of(site, SIMULATOR)) if SIMULATOR in names else None

    def _start(self, site: Site, name: str) -> "subprocess.Popen[bytes]":
        with state_folder.private(), _log_of(site, name).open("ab") as log:
            words = [sys.executable, "-m", "tms_runtime.run", f"{GROUP}:{name}"]
            env = {**os.environ, **environment(site)}
            child = subprocess.Popen(
                words, env=env, stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT, start_new_session=True
            )
        come_first(NICE, {child.pid})
        session_first(child.pid, NICE)
        return child

    def dead(self) -> list[str]:
        """Stand-ins that have ended, so that the drill has no machine in their place."""
        return [str(child.args[-1]) for child in self._children if child.poll() is not None]  # type: ignore[index]

    def __enter__(self) -> "StandIns":
        return self

    def __exit__(self, _type: type[BaseException] | None, _error: BaseException | None,
                 _trace: TracebackType | None) -> None:  # fmt: skip
        if self.operasim is not None:
            self.operasim.close()
        for child in self._children:
            child.terminate()
        for child in self._children:
            try:
                child.wait(END_LIMIT)
            except subprocess.TimeoutExpired:
                child.kill()
                child.wait()


def _log_of(site: Site, name: str) -> Path:
    return site.state / "log" / f"{GROUP}.{name}.log"
