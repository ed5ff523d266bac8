"""The templates that the tasks of version 6 in tests/data call: those that came with them, and those of configs/."""

from conftest import PROJECT
from tms_config.config import CONFIGS

TASKS = PROJECT / "tests" / "data" / "v6_tasks"  # of the C++ system; their names have __ for the / of folders
OURS = {path.stem: path for path in (CONFIGS / "templates").glob("*.xml")}


def known(name: str) -> str | None:
    """The text of a template."""
    given = {path.stem.rpartition("__")[2]: path for path in TASKS.glob("*.xml")}
    path = OURS.get(name) or given.get(name)
    return None if path is None else path.read_text(encoding="utf-8")
