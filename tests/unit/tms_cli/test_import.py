"""`tms import`: its report, and when nothing is written."""

import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import mongomock
import pytest

from tms_cli.commands import import_
from tms_db import store
from tms_db.tasks import Tasks
from tms_db.templates import Templates

CALLS = """<root><BehaviorTree ID="T">
<Action ID="ExecuteSubtask" model_name="zx200" subtask_name="{}" subtask_parameters="r:pose_1"/>
</BehaviorTree></root>"""
TEXT = """<root main_tree_to_execute="BehaviorTree"><BehaviorTree ID="BehaviorTree">
<LeafNodeZx200 model_name="$model_name$" record_name="$r$" subtask_name="st_zx200_swing"/>
</BehaviorTree><TreeNodesModel/></root>"""


@pytest.fixture
def db(monkeypatch: pytest.MonkeyPatch) -> store.Db:
    found: store.Db = mongomock.MongoClient(tz_aware=True)["rostmsdb"]

    @contextmanager
    def opened() -> Iterator[store.Db]:
        yield found

    monkeypatch.setattr(import_, "opened", opened)
    return found


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "Dig.xml").write_text(TEXT)
    (tmp_path / "dig_once.xml").write_text(CALLS.format("Dig"))
    (tmp_path / "level_once.xml").write_text(CALLS.format("Level"))
    (tmp_path / "launch.xml").write_text("<launch/>")
    (tmp_path / "values.yaml").write_text("initial_parameters:\n- {record_name: FLAGS, values: {n: 1}}\n")
    return tmp_path


def test_the_report_and_what_is_written(db: store.Db, tms, folder: Path) -> None:
    end = tms(import_.command, folder)
    assert end.exit_code == 0, end.output
    assert end.stdout.splitlines() == [
        "Dig.xml: template Dig",
        "dig_once.xml: task 1",
        "level_once.xml: task 2",
        "  warning: it cannot run as it is: line 2: there is no template 'Level'",
        "values.yaml, record 1: record /FLAGS",
        "launch.xml: left out: no tree: there is no <BehaviorTree> in it",
        "3 as they are, 1 with warnings, 0 there already, 0 refused, 1 left out",
    ]
    assert [task.description for task in Tasks(db).all()] == ["dig_once.xml", "level_once.xml"]
    Templates(db).add("Level", TEXT)
    (folder / "more.xml").write_text(CALLS.format("Level").replace('"T"', '"U"'))
    lines = tms(import_.command, folder).stdout.splitlines()
    assert "more.xml: task 3" in lines and "dig_once.xml: task 1 (there already)" in lines
    assert lines[-1] == "1 as they are, 0 with warnings, 4 there already, 0 refused, 1 left out"


def test_a_trial_writes_nothing(db: store.Db, tms, folder: Path) -> None:
    end = tms(import_.command, folder, "--dry-run", "--json")
    assert (end.exit_code, end.stderr) == (0, "nothing was written: this was a trial\n")
    document = json.loads(end.stdout)
    assert document["imported"] is False
    assert document["summary"] == {"as_they_are": 3, "with_warnings": 1, "there": 0, "refused": 0, "left_out": 1}
    assert document["items"][2] == {
        "kind": "task", "place": "level_once.xml", "name": "2", "state": "new", "why": None,
        "warnings": ["it cannot run as it is: line 2: there is no template 'Level'"],
    }  # fmt: skip
    assert not any(db[name].count_documents({}) for name in ("task", "subtask"))


def test_what_is_refused_keeps_the_rest_out(db: store.Db, tms, folder: Path) -> None:
    (folder / "broken.xml").write_text("<root>\n<a></root>")
    end = tms(import_.command, folder)
    assert end.exit_code == 1
    assert "--skip-refused" in end.stderr
    (line,) = [line for line in end.stdout.splitlines() if line.startswith("broken.xml")]
    assert line.startswith("broken.xml: refused: line 2: not well-formed")
    assert Tasks(db).all() == [] and Templates(db).all() == []
    assert tms(import_.command, folder, "--dry-run").exit_code == 1
    assert tms(import_.command, folder, "--dry-run", "--skip-refused").exit_code == 0
    assert Tasks(db).all() == []
    end = tms(import_.command, folder, "--skip-refused", "--json")
    assert (end.exit_code, json.loads(end.stdout)["imported"]) == (0, True)
    assert len(Tasks(db).all()) == 2


def test_many_warnings_of_one_tree_are_counted(db: store.Db, tms, tmp_path: Path) -> None:
    leaves = "".join(f'<Repeat num_cycles="x{n}"><AlwaysSuccess/></Repeat>' for n in range(6))
    text = f'<root><BehaviorTree ID="T"><Sequence>{leaves}</Sequence></BehaviorTree></root>'
    (tmp_path / "t.xml").write_text(text)
    lines = tms(import_.command, tmp_path).stdout.splitlines()
    assert [line[:10] for line in lines[1:5]] == ["  warning:"] * 3 + ["  and 3 mo"]


def test_templates_of_the_import_count_before_stored_ones(db: store.Db, tms, folder: Path) -> None:
    Templates(db).add("Dig", TEXT.replace("LeafNodeZx200", "NoNode"))
    lines = tms(import_.command, folder, "--replace").stdout.splitlines()
    assert lines[:2] == ["Dig.xml: template Dig", "dig_once.xml: task 1"]
    assert lines[2].startswith("level_once.xml")
