"""`tms:store`: becomes the embedded store's server, a separate program that our code never imports."""

import os
import shutil
import sys
from pathlib import Path

from tms_config import state_folder
from tms_config.config import PROJECT, Site
from tms_reason.errors import ConfigError

PROGRAM = PROJECT / ".venv-store" / "bin" / "secantusd-py"
NEEDED_BYTES = 200 * 2**20


def check(site: Site) -> Path:
    """The store's folder, made if missing.

    Raises:
        ConfigError: the program is not installed, or the folder has no room or cannot be written.
    """
    folder = site.state / "store"
    if not PROGRAM.exists():
        raise ConfigError(f"the embedded store is not installed ({PROGRAM} is missing): run `make setup`")
    try:
        state_folder.make(site.state)
        folder.mkdir(mode=0o700, exist_ok=True)
        free = shutil.disk_usage(folder).free
    except OSError as error:
        raise ConfigError(f"{folder}: the store cannot write there ({error.strerror}); set TMS_STATE") from error
    if free < NEEDED_BYTES:
        raise ConfigError(
            f"{folder}: only {free / 2**20:.0f} MB free, the store needs {NEEDED_BYTES / 2**20:.0f} MB: "
            "free some space or set TMS_STATE to another disk"
        )
    return folder


def become(site: Site) -> None:
    """Replace this process by the store's server (same pid, so supervisord sees the real one)."""
    folder = check(site)
    # The ROS wheels' variables would make the other environment load this one's native libraries.
    hidden = ("LD_LIBRARY_PATH", "_ROS_WHEELS_BOOTSTRAP_COMPLETE", "PYTHONPATH")
    clean = {key: value for key, value in os.environ.items() if key not in hidden}
    words = [str(PROGRAM), "--host", "127.0.0.1", "--port", str(site.file.ports.store)]
    sys.stdout.flush()
    os.execve(PROGRAM, [*words, "--storage-path", str(folder), "--cache-size", "64M"], clean)
