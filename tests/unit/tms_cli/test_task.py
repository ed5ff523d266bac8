"""`tms task`: files that are none, what is stored already, checks with and without a scheduler."""

import json
from pathlib import Path

import pytest
from tms_msg_db.msg import Task
from tms_msg_db.srv import AddTask, GetTask, ListTasks
from tms_msg_ts.srv import CheckTask

from tms_cli import check_task, task_file
from tms_cli.commands import task
from tms_reason.errors import DbError, TaskError
from tms_reason.reason import Foreign
from tms_ts.bt import TreeError

GOOD = '<root><BehaviorTree ID="T"><Sequence><AlwaysSuccess/></Sequence></BehaviorTree></root>'
LEAF = """<root><BehaviorTree ID="T">
<Sequence>
<LeafNodeZx200 record_name="{next}" subtask_name="st_zx200_swing"/></Sequence></BehaviorTree></root>"""
BAD = '<root>\n<BehaviorTree ID="T">\n<Sequnce><AlwaysSuccess/></Sequnce>\n</BehaviorTree></root>'


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "task.xml"
    path.write_text(GOOD)
    return path


def test_files_that_are_no_task_are_told_in_one_line(tmp_path: Path, mesh, tms) -> None:
    (tmp_path / "latin.xml").write_bytes(b"<root>\xff</root>")
    with (tmp_path / "huge.xml").open("wb") as huge:
        huge.truncate(100 * 2**20)  # sparse: reading it would be noticed
    for name, says in [
        ("missing.xml", "cannot be read"),
        ("", "is no file"),
        ("latin.xml", "is not UTF-8"),
        ("huge.xml", "100.0 MB"),
    ]:
        error = tms(task.command, "add", str(tmp_path / name)).exception
        assert isinstance(error, TaskError)
        assert says in str(error)
        assert "\n" not in str(error)
    assert not mesh.asked


def test_a_pipe_or_device_is_no_task() -> None:
    with pytest.raises(TaskError, match="/dev/zero is no file"):
        task_file.read("/dev/zero")


def test_add_says_the_number(mesh, tms, file: Path) -> None:
    mesh.answers["/tms/db/add_task"] = AddTask.Response(task_id=3, model_name="zx200")
    assert "stored as task 3" in tms(task.command, "add", file, "--description", "x").stdout
    assert mesh.asked[0][1] == {"task_sequence": GOOD, "description": "x"}


def test_the_same_file_twice_is_reported_and_no_error(mesh, tms, file: Path) -> None:
    mesh.answers["/tms/db/add_task"] = AddTask.Response(task_id=3, already_stored=True)
    end = tms(task.command, "add", file)
    assert (end.exit_code, end.stdout) == (0, "already stored as task 3\n")
    document = json.loads(tms(task.command, "add", file, "--json").stdout)
    assert document == {"task_id": 3, "already_stored": True, "model_name": ""}


def test_what_the_database_finds_wrong_names_the_file(mesh, tms, file: Path) -> None:
    mesh.answers["/tms/db/add_task"] = TaskError(Foreign("line 3: there is no tree"))
    assert str(tms(task.command, "add", file).exception) == f"{file}: line 3: there is no tree"


def test_show_prints_the_xml_as_it_was_drawn(mesh, tms) -> None:
    stored = Task(task_id=1, model_name="zx200", description="d", task_sequence=GOOD)
    mesh.answers["/tms/db/get_task"] = GetTask.Response(task=stored)
    end = tms(task.command, "show", "1")
    assert end.stdout == f"{GOOD}\n"
    assert end.stderr == "task 1, zx200: d\n"
    assert json.loads(tms(task.command, "show", "1", "--json").stdout)["task_sequence"] == GOOD


def test_show_draws_a_stored_task(mesh, tms) -> None:
    mesh.answers["/tms/db/get_task"] = GetTask.Response(task=Task(task_id=1, model_name="zx200", task_sequence=LEAF))
    end = tms(task.command, "show", "1", "--ascii")
    assert end.stdout.splitlines() == [
        "{-} Sequence",
        '    --> LeafNodeZx200 record_name="{next}" subtask_name="st_zx200_swing"',
    ]
    assert end.stderr == "task 1, zx200: \n"
    dot = tms(task.command, "show", "1", "--dot").stdout
    assert dot.startswith("digraph ")
    assert dot.count("->") == 1


def test_show_draws_a_file_with_what_it_includes(mesh, tms, tmp_path: Path) -> None:
    (tmp_path / "other.xml").write_text(GOOD.replace('"T"', '"Other"'))
    (tmp_path / "main.xml").write_text(
        '<root main_tree_to_execute="M"><include path="other.xml"/>'
        '<BehaviorTree ID="M"><SubTree ID="Other"/></BehaviorTree></root>'
    )
    end = tms(task.command, "show", tmp_path / "main.xml", "--ascii")
    assert [line.strip() for line in end.stdout.splitlines()] == [
        "-^- Other (SubTree)",
        "{-} Sequence",
        "--> AlwaysSuccess",
    ]
    assert tms(task.command, "show", tmp_path / "other.xml").stdout.startswith("<root>")
    assert not mesh.asked


def test_show_of_what_cannot_be_drawn(mesh, tms, file: Path) -> None:
    file.write_text(BAD)
    error = tms(task.command, "show", file, "--dot").exception
    assert isinstance(error, TreeError)
    assert error.line == 3
    assert tms(task.command, "show", file, "--dot", "--json").exit_code == 2
    for number in ("0", "99999999999", "9" * 5000):
        error = tms(task.command, "show", number, "--ascii").exception
        assert isinstance(error, TaskError)
        assert error.code == "NO_TASK"
    assert not mesh.asked


def test_list_for_machines(mesh, tms) -> None:
    mesh.answers["/tms/db/list_tasks"] = ListTasks.Response(tasks=[Task(task_id=2, description="d")])
    assert json.loads(tms(task.command, "list", "--json").stdout) == [
        {"task_id": 2, "model_name": "", "description": "d", "added_at": None}
    ]


def test_check_lists_goals_and_says_that_only_the_structure_was_checked(mesh, tms, file: Path) -> None:
    file.write_text(LEAF)
    end = tms(task.command, "check", file)
    assert end.exit_code == 0
    assert [line.split() for line in end.stdout.splitlines()[:2]] == [
        ["LINE", "MACHINE", "SUBTASK", "RECORD", "NODE"],
        ["3", "zx200", "st_zx200_swing", "{next}", "0.0"],
    ]
    assert end.stdout.splitlines()[-1] == f"{file}: its structure is right"
    assert "unchecked" in end.stderr
    document = json.loads(tms(task.command, "check", file, "--json").stdout)
    assert document["goals"] == [
        {"machine": "zx200", "subtask": "st_zx200_swing", "record": "{next}", "path": "0.0", "line": 3, "template": ""}
    ]
    assert (document["ok"], document["checked_by"], document["nodes"]) == (True, "structure", 2)


def test_check_finds_errors_without_a_mesh(mesh, tms, file: Path) -> None:
    file.write_text(BAD)
    end = tms(task.command, "check", file, "--json")
    document = json.loads(end.stdout)
    assert end.exit_code == 1
    assert document["ok"] is False
    assert "line 3" in document["errors"][0]
    assert "Sequence" in document["errors"][0], "the hint"
    assert not mesh.asked, "the scheduler needs not look at it"


def test_check_asks_the_scheduler_for_records(mesh, tms, file: Path) -> None:
    mesh.answers["/tms/check_task"] = CheckTask.Response(errors=["no record zx200/a"], warnings=["careful"])
    end = tms(task.command, "check", file)
    assert end.exit_code == 1
    assert f"{file}: error: no record zx200/a" in end.stdout
    assert f"{file}: warning: careful" in end.stdout
    assert not end.stderr
    mesh.answers["/tms/check_task"] = TaskError(Foreign("line 9: newer than this tms"))
    assert "error: line 9" in tms(task.command, "check", file).stdout
    mesh.answers["/tms/check_task"] = DbError(Foreign("the store is away"))
    assert isinstance(tms(task.command, "check", file).exception, DbError)


def test_check_of_a_stored_task(mesh, tms) -> None:
    mesh.answers["/tms/db/get_task"] = GetTask.Response(task=Task(task_id=7, task_sequence=LEAF))
    mesh.answers["/tms/check_task"] = CheckTask.Response()
    end = tms(task.command, "check", "7")
    assert "zx200" in end.stdout
    assert "7: can run" in end.stdout
    assert mesh.asked[-1] == ("/tms/check_task", {"task_id": 7})
    for number in ("0", "99999999999"):
        assert "there is no task" in str(tms(task.command, "check", number).exception)


def test_check_follows_includes_and_says_that_they_are_not_stored(mesh, tms, tmp_path: Path) -> None:
    (tmp_path / "other.xml").write_text(GOOD.replace('"T"', '"Other"'))
    (tmp_path / "main.xml").write_text(
        '<root main_tree_to_execute="M"><include path="other.xml"/>'
        '<BehaviorTree ID="M"><SubTree ID="Other"/></BehaviorTree></root>'
    )
    end = tms(task.command, "check", tmp_path / "main.xml")
    assert end.exit_code == 0
    assert "cannot be stored" in end.stdout


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name, text in {
        "a.xml": GOOD, "b.xml": BAD, "c.xml": "<root><TreeNodesModel/></root>", "d.XML": "<robot/>", "e.txt": "no",
        "f.xml": GOOD.replace("<AlwaysSuccess/>", '<Repeat num_cycles="-1"><AlwaysSuccess/></Repeat>'),
        "sub/g.xml": GOOD, "sub/h.xml": "<root>",
    }.items():  # fmt: skip
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    return tmp_path


def test_check_of_a_folder_is_one_line_a_file(mesh, tms, folder: Path) -> None:
    end = tms(task.command, "check", folder)
    assert end.exit_code == 1
    lines = end.stdout.splitlines()
    assert lines[0] == "a.xml: ok"
    assert lines[1].startswith("b.xml: 1 error: line 3")
    assert lines[2] == "c.xml: no task: it has a TreeNodesModel only (a palette for Groot)"
    assert lines[3] == "d.XML: no task: its outermost element is <robot>, not <root>"
    assert lines[4] == "f.xml: 1 warning"
    assert lines[5:] == ["5 files: 1 ok, 1 with warnings, 1 with errors, 2 no task"]
    assert "unchecked" in end.stderr
    assert len(mesh.asked) == 1, "a scheduler that is not there is not asked again"


def test_check_of_a_folder_and_those_inside(mesh, tms, folder: Path) -> None:
    mesh.answers["/tms/check_task"] = CheckTask.Response()
    document = json.loads(tms(task.command, "check", folder, "--recursive", "--json").stdout)
    assert [found["file"] for found in document["files"]][-2:] == ["sub/g.xml", "sub/h.xml"]
    assert document["summary"] == {"files": 7, "ok": 3, "warnings": 0, "errors": 2, "no_task": 2}
    assert document["files"][0]["checked_by"] == "scheduler"
    (folder / "b.xml").unlink()
    assert tms(task.command, "check", folder).exit_code == 0


def test_check_of_a_folder_goes_on_after_a_file_that_cannot_be_read(mesh, tms, tmp_path: Path) -> None:
    (tmp_path / "a.xml").write_bytes(b"<root>\xff</root>")
    (tmp_path / "b.xml").write_text(GOOD)
    end = tms(task.command, "check", tmp_path)
    assert end.stdout.splitlines()[:2] == ["a.xml: 1 error: is not UTF-8 text (byte 6): save it as UTF-8", "b.xml: ok"]


def test_check_tells_how_far_it_is(mesh, tms, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(check_task, "PROGRESS", 0.0)
    end = tms(task.command, "check", folder, "--json")
    assert json.loads(end.stdout)["summary"]["files"] == 5
    assert "4 of 5 files checked" in end.stderr


def test_check_of_what_is_no_task_or_no_folder(mesh, tms, folder: Path, tmp_path: Path) -> None:
    end = tms(task.command, "check", folder / "c.xml")
    assert end.exit_code == 1
    assert "this is no task" in end.stdout
    assert tms(task.command, "check", folder / "a.xml", "--recursive").exit_code == 2
    (tmp_path / "empty").mkdir()
    assert "no .xml files" in str(tms(task.command, "check", tmp_path / "empty").exception)
