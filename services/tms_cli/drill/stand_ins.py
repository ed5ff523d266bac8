"""Runs the stand-ins as children of the drill: they represent machines, which a power cut of our PC does not stop."""

import os
import subprocess
import sys
from types import TracebackType

from tms_config.config import Site
from tms_runtime import state_folder
from tms_runtime.environment import environment
from tms_runtime.priority import come_first, session_first

GROUP = "sim"  # group of the stand-ins in the process table
END_LIMIT = 5.0  # s
NICE = -15  # above the gateways, since a machine does not wait for them


class StandIns:
    """Starts the stand-ins from the main thread; they end with it, whatever ends it."""

    def __init__(self, site: Site) -> None:
        self._children = [self._start(site, machine) for machine in site.file.machines]

    def _start(self, site: Site, machine: str) -> "subprocess.Popen[bytes]":
        with state_folder.private(), (site.state / "log" / f"{GROUP}.{machine}.log").open("ab") as log:
            words = [sys.executable, "-m", "tms_runtime.run", f"{GROUP}:{machine}"]
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
        for child in self._children:
            child.terminate()
        for child in self._children:
            try:
                child.wait(END_LIMIT)
            except subprocess.TimeoutExpired:
                child.kill()
                child.wait()
