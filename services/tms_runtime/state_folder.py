"""The state folder of a site is for its user alone: logs, latches, journals and the embedded store tell of the work."""

import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from tms_config.reasons import BadFile
from tms_reason.errors import ConfigError
from tms_runtime.reasons import OthersFile

UMASK = 0o077
OTHERS = 0o077  # what group and others may do


def make(folder: Path) -> None:
    """The folder, private from its first moment; folders above it are as this user makes folders."""
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)


@contextmanager
def private() -> Iterator[None]:
    """What is written meanwhile, and by processes that are started, is for this user alone."""
    before = os.umask(UMASK)
    try:
        yield
    finally:
        os.umask(before)


def tighten(folder: Path) -> int:
    """Take away what others may do with the folder and everything in it, as older releases left it; how many.

    Raises:
        ConfigError: something in it belongs to another user.
    """
    closed = 0
    for place, folders, files in os.walk(folder):
        for path in (Path(place), *(Path(place, name) for name in (*folders, *files))):
            try:
                closed += _close(path)
            except FileNotFoundError:
                continue  # it came and went
            except PermissionError as error:
                raise ConfigError(BadFile(str(path), OthersFile(os.getuid()))) from error
    return closed


def _close(path: Path) -> bool:
    mode = path.lstat().st_mode
    if stat.S_ISLNK(mode) or not mode & OTHERS:
        return False
    path.chmod(stat.S_IMODE(mode) & ~OTHERS)
    return True
