"""The registration node finds a task file by path or by name."""

from pathlib import Path

import pytest

from tms_db.task_generator import TASKS, find
from tms_reason.errors import TaskError


@pytest.mark.parametrize("name", ["one_loading_cycle", "one_loading_cycle.xml", str(TASKS / "one_loading_cycle.xml")])
def test_names_that_are_found(name: str) -> None:
    assert find(name) == TASKS / "one_loading_cycle.xml"


def test_a_file_elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "mine.xml").write_text("<root/>")
    monkeypatch.chdir(tmp_path)
    assert find("mine.xml") == Path("mine.xml")


@pytest.mark.parametrize(("name", "says"), [("", "no file is given"), ("none", "no file 'none'"), (".", "no file '.'")])
def test_names_that_are_not_there(name: str, says: str) -> None:
    with pytest.raises(TaskError, match=says):
        find(name)
