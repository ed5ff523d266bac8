"""Files that commands write: one that is there already stays, unless the user wants it replaced."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from tms_cli.reasons import NameTaken
from tms_reason.errors import TmsError


def write(file: Path, data: bytes, overwrite: bool = False) -> None:
    """Write a file.

    Raises:
        TmsError: NO_FILE: it is there, or cannot be written.
    """
    with written(file), file.open("wb" if overwrite else "xb") as new:
        new.write(data)


@contextmanager
def written(file: Path) -> Iterator[None]:
    """Errors of the system while a file is written become a TmsError, NO_FILE."""
    try:
        yield
    except OSError as error:
        raise TmsError(NameTaken(str(file), str(error.strerror)), "NO_FILE") from error
