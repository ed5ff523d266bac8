"""The files that `tms task` and `tms template` read."""

from pathlib import Path

from tms_cli.reasons import NoTaskFile, NoXmlFiles, NoXmlHere
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


def xml_files(folder: Path | str, *, recursive: bool = False) -> list[Path]:
    """The XML files of a folder, in the order of their names.

    Raises:
        TaskError: there are none.
    """
    names = Path(folder).rglob("*") if recursive else Path(folder).iterdir()
    files = sorted(name for name in names if name.suffix.lower() == ".xml" and not name.is_dir())
    if not files:
        raise TaskError(NoXmlFiles(str(folder)) if recursive else NoXmlHere(str(folder)), TaskError.code)
    return files
