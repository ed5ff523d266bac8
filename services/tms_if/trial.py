"""`sim:operasim`: our stand-in of OperaSim-PhysX in place of Unity, a separate program that our code never imports."""

import os
import sys

from tms_config.config import PROJECT, Site
from tms_if.reasons import NoTrial
from tms_reason.errors import ConfigError
from tms_runtime.priority import come_first

FOLDER = PROJECT / "tests"  # only a clone has it


def exec_program(site: Site) -> None:
    """Replace this process by the stand-in (same pid, so supervisord sees the real one).

    Raises:
        ConfigError: this is an installation without the stand-in, or the site has no scene for it.
    """
    bridge = site.bridge
    if not (FOLDER / "operasim").is_dir() or bridge.trial is None:
        raise ConfigError(NoTrial(str(FOLDER / "operasim")))
    words = ["-m", "operasim", "--scene", bridge.trial, "--port", str(bridge.port), "--control-port", "0"]
    sys.stdout.flush()
    come_first(-12, {os.getpid()}, realtime=3)  # it is a machine, which no PC can keep from its motions
    os.chdir(FOLDER)
    os.execv(sys.executable, [sys.executable, *words])
