"""`tms demo`: its steps in order, and exit code 0 only on success."""

from types import SimpleNamespace
from typing import Any

import pytest
from tms_msg_db.srv import AddTask, AddTemplate

from tms_cli import stored_records
from tms_cli.commands import demo, run
from tms_cli.loads import Carried
from tms_reason.errors import DbError, TmsError
from tms_reason.reason import Foreign


@pytest.fixture
def steps(mesh, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    done: list[str] = []

    def step(name: str, answer: Any = None) -> Any:
        def take(*_: Any, **__: Any) -> Any:
            done.append(name)
            return answer

        return take

    monkeypatch.setattr(demo.session, "LATCHED_LIMIT", 0.0)  # no gateway is here to report
    monkeypatch.setattr(demo.mesh, "up", step("up", True))
    monkeypatch.setattr(demo.mesh, "wait_ready", step("ready"))
    monkeypatch.setattr(
        stored_records, "load_file", step("records", {"created": [], "changed": [], "unchanged": ["a"]})
    )
    mesh.answers["/tms/db/add_task"] = lambda **_: step("task")() or AddTask.Response(task_id=4, already_stored=True)
    mesh.answers["/tms/db/add_template"] = lambda template_name, **_: (
        step(f"template {template_name}")() or AddTemplate.Response()
    )
    return done


class Ran:
    outcome = "success"
    view = SimpleNamespace(loads=None)

    def __init__(self, node: Any, task_id: int, ignore_warnings: bool) -> None:
        assert task_id == 4
        assert not ignore_warnings

    def finish(self, display: Any) -> run.End:
        return run.End("r1", self.outcome, "", "", 20.0)


@pytest.mark.parametrize(("outcome", "code"), [("success", 0), ("failure", 1), ("refused", 1)])
def test_the_steps_and_the_exit_code(steps, tms, monkeypatch, outcome: str, code: int) -> None:
    monkeypatch.setattr(Ran, "outcome", outcome)
    monkeypatch.setattr(run, "Runner", Ran)
    end = tms(demo.command)
    templates = [f"template {path.stem}" for path in sorted(demo.TEMPLATES.glob("*.xml"))]
    assert templates
    assert steps == ["up", "ready", *["records"] * len(demo.PARAMETERS), *templates, "task"]
    assert end.exit_code == code
    assert "tms events r1" in end.stdout
    assert "http://127.0.0.1:8080" in end.stderr
    assert "make down" in end.stderr


def test_the_last_lines_tell_what_was_moved(steps, tms, monkeypatch) -> None:
    bucket, truck = Carried(bucket=True), Carried(bucket=False)
    for loose in (0.0, 0.7, 0.0, 0.8, 0.0):
        bucket.take(loose, loose / 1.25, 0.83)
    for loose in (0.0, 0.7, 1.5, 0.0):
        truck.take(loose, loose / 1.25, 5.9)
    monkeypatch.setattr(run, "Runner", Ran)
    monkeypatch.setattr(Ran, "view", SimpleNamespace(loads=SimpleNamespace(of={"zx200": bucket, "ic120": truck})))
    page = "# TYPE tms_ground_mass_error_kilograms gauge\ntms_ground_mass_error_kilograms 2e-10\n"
    monkeypatch.setattr(demo.metrics, "page", lambda row: (200, page))
    said = tms(demo.command).stderr
    lines = [
        "the stand-ins live 5 times as fast as machines do",
        "cycles of the excavator: 2",
        "loaded: 1.20 m³ as it lay, 1.50 m³ loose",
        "tipped: 1.50 m³ loose",
        "mass made or lost: 2.0e-10 kg",
        "duration: 20 s, 100 s of the machines",
    ]
    places = [said.index(line) for line in lines]
    assert places == sorted(places)


def test_a_template_of_somebody_elses_stays(steps, mesh, tms, monkeypatch) -> None:
    monkeypatch.setattr(run, "Runner", Ran)
    mesh.answers["/tms/db/add_template"] = DbError(Foreign("another text"), "TEMPLATE_EXISTS")
    assert tms(demo.command).exit_code == 0
    assert not [one for one in mesh.asked if one[1].get("replace")]
    mesh.answers["/tms/db/add_template"] = DbError(Foreign("the store is away"), "STORE_DOWN")
    assert isinstance(tms(demo.command).exception, DbError)


def test_a_mesh_that_does_not_come_up_ends_the_demo(steps, tms, monkeypatch) -> None:
    def fails(*_: Any) -> None:
        raise TmsError(Foreign("tms:db is not ready after 60 s: no store; see `tms logs tms:db`"))

    monkeypatch.setattr(demo.mesh, "wait_ready", fails)
    assert "tms logs tms:db" in str(tms(demo.command).exception)
    assert "records" not in steps


def test_the_files_of_the_demo_exist() -> None:
    assert all(file.is_file() for file in demo.PARAMETERS)
    assert demo.TASK.is_file()
    assert demo.TEMPLATES.is_dir()
