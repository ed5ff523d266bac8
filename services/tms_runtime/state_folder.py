"""Keeps a site's state folder private to its user: logs, latches, journals and the embedded store describe the work."""

import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from tms_config.reasons import BadFile
from tms_reason.errors import ConfigError
from tms_runtime.reasons import OthersFile

UMASK = 0o077
OTHERS = 0o077  # permissions of group and others


def armed_note(folder: Path, machine: str) -> Path:
    """The note on the disk that a machine is armed."""
    return folder / "rc" / f"{machine}.armed"


def make(folder: Path) -> None:
    """Make the folder, private from its first moment; folders above it get this user's usual permissions."""
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)


@contextmanager
def private() -> Iterator[None]:
    """Keep files private that this process, or a process it starts, makes meanwhile."""
    before = os.umask(UMASK)
    try:
        yield
    finally:
        os.umask(before)


def tighten(folder: Path) -> int:
    """Remove others' permissions on the folder and all in it, as older releases left them; returns how many.

    Raises:
        ConfigError: a file in it belongs to another user.
    """
    closed = 0
    for place, folders, files in os.walk(folder):
        for path in (Path(place), *(Path(place, name) for name in (*folders, *files))):
            try:
                closed += _close(path)
            except FileNotFoundError:
                continue  # it was removed meanwhile
            except PermissionError as error:
                raise ConfigError(BadFile(str(path), OthersFile(os.getuid()))) from error
    return closed


def _close(path: Path) -> bool:
    mode = path.lstat().st_mode
    if stat.S_ISLNK(mode) or not mode & OTHERS:
        return False
    path.chmod(stat.S_IMODE(mode) & ~OTHERS)
    return True
