"""The files that `tms task` reads."""

from pathlib import Path

from tms_cli.reasons import NoTaskFile
from tms_reason.errors import TaskError


def read(file: str) -> str:
    """Text of a task file.

    Raises:
        TaskError: the file is missing, too big, no regular file or no text.
    """
    from tms_db import task_text

    path = Path(file)
    if path.exists() and not path.is_file():
        raise TaskError(NoTaskFile(file), TaskError.code)
    return task_text.read_file(path)
