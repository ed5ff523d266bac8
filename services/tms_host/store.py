"""`tms:store`: the embedded store's server, a separate program that our code never imports."""

import os
import shutil
import sys
from pathlib import Path

from tms_config.config import PROJECT, Site
from tms_config.reasons import BadFile
from tms_host.reasons import CannotBeWritten, NoProgram, NoRoom
from tms_reason.errors import ConfigError
from tms_runtime import state_folder

PROGRAM = PROJECT / ".venv-store" / "bin" / "secantusd-py"
NEEDED_BYTES = 200 * 2**20
# The engine (WiredTiger) lets nobody go on while a fifth of its cache waits to be written, and what a write
# that goes on has changed cannot be written: a document twice (itself, and in the log that change streams
# read), and its indexes. A fifth must hold three times the largest document (16 MB), or the store hangs.
# It is a ceiling, not a need.
CACHE = "384M"


def check(site: Site) -> Path:
    """The store's folder, made if missing.

    Raises:
        ConfigError: the program is not installed, or the folder has no room or cannot be written.
    """
    folder = site.state / "store"
    if not PROGRAM.exists():
        raise ConfigError(NoProgram(str(PROGRAM)))
    try:
        state_folder.make(site.state)
        folder.mkdir(mode=0o700, exist_ok=True)
        free = shutil.disk_usage(folder).free
    except OSError as error:
        raise ConfigError(BadFile(str(folder), CannotBeWritten(str(error.strerror)))) from error
    if free < NEEDED_BYTES:
        raise ConfigError(BadFile(str(folder), NoRoom(free / 2**20, NEEDED_BYTES / 2**20)))
    return folder


def exec_program(site: Site) -> None:
    """Replace this process by the store's server (same pid, so supervisord sees the real one).

    Raises:
        ConfigError: as `check`.
    """
    folder = check(site)
    # With the ROS wheels' variables, the store would load the native libraries of this environment.
    hidden = ("LD_LIBRARY_PATH", "_ROS_WHEELS_BOOTSTRAP_COMPLETE", "PYTHONPATH")
    clean = {key: value for key, value in os.environ.items() if key not in hidden}
    argv = [str(PROGRAM), "--host", "127.0.0.1", "--port", str(site.file.ports.store)]
    sys.stdout.flush()
    os.execve(PROGRAM, [*argv, "--storage-path", str(folder), "--cache-size", CACHE], clean)
