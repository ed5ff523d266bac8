"""`tms template`, and what verbs for tasks do with templates."""

import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from tms_msg_db.msg import Task, Template
from tms_msg_db.srv import AddTemplate, GetTask, GetTemplate, ListTemplates, RemoveTemplate
from tms_msg_ts.srv import CheckTask

from tms_cli import session
from tms_cli.commands import task, template
from tms_reason.errors import DbError, TaskError, TmsError
from tms_reason.reason import Foreign

TEXT = """<root main_tree_to_execute="BehaviorTree"><BehaviorTree ID="BehaviorTree">
<LeafNodeZx200 model_name="$model_name$" record_name="$r$" subtask_name="st_zx200_swing"/>
</BehaviorTree><TreeNodesModel/></root>"""
CALLS = """<root><BehaviorTree ID="T">
<Action ID="ExecuteSubtask" model_name="zx200" subtask_name="Dig" subtask_parameters="r:pose_1"/>
</BehaviorTree></root>"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "Dig.xml"
    path.write_text(TEXT)
    return path


def stored(template_name: str) -> GetTemplate.Response | TmsError:
    if template_name == "Dig":
        return GetTemplate.Response(
            stored=Template(template_name=template_name, model_name="zx200", task_sequence=TEXT)
        )
    return DbError(Foreign("there is none"), "TEMPLATE_MISSING")


def test_add_takes_files_and_folders_by_their_names(mesh, tms, file: Path) -> None:
    (file.parent / "Level.xml").write_text(TEXT)
    (file.parent / "notes.txt").write_text("no")
    answers = {"Dig": AddTemplate.Response(model_name="zx200"), "Level": AddTemplate.Response(already_stored=True)}
    mesh.answers["/tms/db/add_template"] = lambda template_name, **_: answers[template_name]
    assert tms(template.command, "add", file.parent).stdout.splitlines() == [
        "template Dig stored", "template Level is stored already",
    ]  # fmt: skip
    assert mesh.asked[0][1] == {"template_name": "Dig", "task_sequence": TEXT, "description": "", "replace": False}
    answers["Dig"] = AddTemplate.Response(replaced=True)
    end = tms(template.command, "add", file, "--replace", "--description", "digs")
    assert (end.exit_code, end.stdout) == (0, "template Dig replaced\n")
    assert mesh.asked[-1][1]["replace"] is True and mesh.asked[-1][1]["description"] == "digs"
    assert json.loads(tms(template.command, "add", file, "--json").stdout) == [
        {"name": "Dig", "already_stored": False, "replaced": True, "model_name": ""}
    ]


def test_what_the_database_finds_wrong_names_the_file(mesh, tms, file: Path) -> None:
    mesh.answers["/tms/db/add_template"] = TaskError(Foreign("line 3: there is no tree"))
    assert str(tms(template.command, "add", file).exception) == f"{file}: line 3: there is no tree"
    assert "cannot be read" in str(tms(template.command, "add", file.parent / "no.xml").exception)
    (file.parent / "empty").mkdir()
    assert "no .xml files" in str(tms(template.command, "add", file.parent / "empty").exception)


def test_list_show_and_rm(mesh, tms) -> None:
    mesh.answers["/tms/db/list_templates"] = ListTemplates.Response(
        templates=[Template(template_name="Dig", description="d")]
    )
    mesh.answers["/tms/db/get_template"] = stored
    mesh.answers["/tms/db/remove_template"] = RemoveTemplate.Response()
    assert json.loads(tms(template.command, "list", "--json").stdout) == [
        {"name": "Dig", "model_name": "", "description": "d", "added_at": None}
    ]
    heads, row = tms(template.command, "list").stdout.splitlines()
    assert heads.split() == ["TEMPLATE", "MODEL", "STORED", "DESCRIPTION"]
    assert (row.split()[0], row.split()[-1]) == ("Dig", "d")
    assert tms(template.command, "show", "Dig").stdout == f"{TEXT}\n"
    assert json.loads(tms(template.command, "show", "Dig", "--json").stdout)["task_sequence"] == TEXT
    assert tms(template.command, "show", "Gone").exception.code == "TEMPLATE_MISSING"
    assert tms(template.command, "rm", "Dig").stdout == "template Dig removed\n"


def test_check_tells_keys_and_errors(mesh, tms, file: Path) -> None:
    end = tms(template.command, "check", file)
    assert (end.exit_code, end.stdout.splitlines()) == (
        0, ["keys: model_name, r", f"{file}: its structure is right"],
    )  # fmt: skip
    mesh.answers["/tms/db/get_template"] = stored
    assert json.loads(tms(template.command, "check", "Dig", "--json").stdout) == {
        "ok": True, "keys": ["model_name", "r"], "errors": [], "warnings": [],
    }  # fmt: skip
    file.write_text(TEXT.replace("record_name", "recordname"))
    end = tms(template.command, "check", file)
    assert end.exit_code == 1
    assert f"{file}: error: line 2" in end.stdout
    assert tms(template.command, "check", "Gone").exception.code == "TEMPLATE_MISSING"


def test_a_task_is_checked_and_drawn_with_stored_templates(mesh, tms, tmp_path: Path) -> None:
    (tmp_path / "t.xml").write_text(CALLS)
    mesh.answers["/tms/db/get_template"] = stored
    mesh.answers["/tms/check_task"] = CheckTask.Response()
    (goal,) = json.loads(tms(task.command, "check", tmp_path / "t.xml", "--json").stdout)["goals"]
    assert goal == {
        "machine": "zx200", "subtask": "st_zx200_swing", "record": "pose_1", "path": "0", "line": 2,
        "template": "Dig:2",
    }  # fmt: skip
    drawn = tms(task.command, "show", tmp_path / "t.xml", "--ascii").stdout
    assert drawn.startswith('--> LeafNodeZx200 model_name="zx200" record_name="pose_1"')
    mesh.answers["/tms/db/get_task"] = GetTask.Response(task=Task(task_id=7, task_sequence=CALLS))
    assert "pose_1" in tms(task.command, "check", "7").stdout


def test_one_node_reads_all_templates_of_a_picture(mesh, tms, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    opened: list[None] = []
    real = session.ros

    @contextmanager
    def counted() -> Iterator[object]:
        opened.append(None)
        with real() as node:
            yield node

    monkeypatch.setattr(session, "ros", counted)
    call = CALLS.split("\n")[1]
    (tmp_path / "t.xml").write_text(CALLS.replace(call, f"<Sequence>{call}{call.replace('Dig', 'Level')}</Sequence>"))
    mesh.answers["/tms/db/get_template"] = lambda template_name: stored("Dig")
    assert tms(task.command, "show", tmp_path / "t.xml", "--ascii").exit_code == 0
    assert (len(opened), len(mesh.asked)) == (1, 2)


def test_a_task_whose_template_nobody_has(mesh, tms, tmp_path: Path) -> None:
    (tmp_path / "t.xml").write_text(CALLS.replace("Dig", "Gone"))
    mesh.answers["/tms/db/get_template"] = stored
    end = tms(task.command, "check", tmp_path / "t.xml")
    assert end.exit_code == 1
    assert "error: line 2: there is no template 'Gone'" in end.stdout


def test_without_a_mesh_templates_are_not_looked_into(mesh, tms, tmp_path: Path) -> None:
    for name in ("a.xml", "b.xml"):
        (tmp_path / name).write_text(CALLS)
    end = tms(task.command, "check", tmp_path)
    assert (end.exit_code, end.stdout.splitlines()[:2]) == (0, ["a.xml: 1 warning", "b.xml: 1 warning"])
    assert [name for name, _ in mesh.asked] == ["/tms/db/get_template", "/tms/check_task"], "asked once only"
    assert "template 'Dig' is not looked into" in tms(task.command, "check", tmp_path / "a.xml").stdout


def test_what_the_cpp_system_would_do(mesh, tms, tmp_path: Path) -> None:
    (tmp_path / "t.xml").write_text(CALLS.replace("r:pose_1", ""))
    mesh.answers["/tms/db/get_template"] = stored
    assert "error: line 2: in template Dig:2: $r$ has no value" in tms(task.command, "check", tmp_path / "t.xml").stdout
    end = tms(task.command, "check", tmp_path / "t.xml", "--cpp")
    assert (end.exit_code, end.stderr) == (0, "")
    assert "warning: line 2: in template Dig:2: $r$ has no value; the C++ system writes the word none" in end.stdout
    assert "/tms/check_task" not in [name for name, _ in mesh.asked]
