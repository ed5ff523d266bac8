"""`tms plan-check` finds the subtask of a record and shows what the planner answers."""

import json
from collections.abc import Iterator
from contextlib import contextmanager
from types import SimpleNamespace
from typing import Any

import pytest
from builtin_interfaces.msg import Duration
from click.testing import CliRunner, Result
from tms_msg_rp.srv import CheckMotion
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from tms_cli import session
from tms_cli.main import tms
from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_machine.reasons import Busy
from tms_machine.values import to_parameters
from tms_reason.errors import TmsError
from tms_reason.wire import to_line

MODELS = {name: parse(CONFIGS / "machines" / f"{name}.yaml", MachineModel) for name in ("zx200", "ic120")}
DIG = {"position_with_angle": 1.0, "x": 6.0, "y": 1.0, "z": 0.0, "theta_w": 1.5}
RECORDS: dict[str, dict[str, Any]] = {
    "target_excavate_pose": DIG, "another_dig": DIG, "opening": {"target_angle": 0.1}, "flag": {"FLAG": True}
}  # fmt: skip


def plan() -> JointTrajectory:
    points = [
        JointTrajectoryPoint(positions=[0.1 * at, -0.5, 1.5, 0.5, 0.0], time_from_start=Duration(sec=at))
        for at in range(30)
    ]
    return JointTrajectory(joint_names=list(MODELS["zx200"].joints), points=points)


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[str]]:
    actions: list[str] = []
    answers = {
        "excavate": CheckMotion.Response(plan=plan(), clearance=0.42, nearest=to_line(Busy("zx200:rc")), seconds=3.0),
        "release": CheckMotion.Response(error_code="BUSY", error_msg=to_line(Busy("zx200:rc")), lasting=True),
        "change_pose": CheckMotion.Response(plan=plan(), clearance=float("inf")),
    }

    def answer(_: Any, __: str, request: CheckMotion.Request, ___: float) -> CheckMotion.Response:
        actions.append(request.action)
        return answers[request.action]

    def record(_: Any, __: Any, ___: str, *, record_name: str, **____: Any) -> Any:
        if record_name not in RECORDS:
            raise TmsError(Busy("tms:db"))
        return SimpleNamespace(record=SimpleNamespace(values=to_parameters(RECORDS[record_name])))

    @contextmanager
    def ros() -> Iterator[Any]:
        yield SimpleNamespace(call=answer)

    site = SimpleNamespace(
        file=SimpleNamespace(machines={name: SimpleNamespace(model=name) for name in MODELS}),
        model_of=MODELS.__getitem__,
    )
    monkeypatch.setattr(session, "ros", ros)
    monkeypatch.setattr(session, "site", lambda: site)
    monkeypatch.setattr(session, "call", record)
    yield actions


def run(*arguments: str) -> Result:
    return CliRunner().invoke(tms, ["plan-check", *arguments])


def test_a_free_motion_with_its_path(asked: list[str]) -> None:
    said = run("zx200", "target_excavate_pose")
    assert said.exit_code == 0 and asked == ["excavate"]
    assert "straight; it takes 29.0 s" in said.output and "0.42 m apart after 3.0 s" in said.output
    rows = said.output.splitlines()
    assert rows[2].split() == ["s", "swing", "boom", "arm", "bucket", "bucket_end"]
    assert rows[3].split()[0] == "0.0" and rows[-1].split()[:2] == ["29.0", "2.900"] and len(rows) <= 16


def test_as_json_it_has_every_point(asked: list[str]) -> None:
    found = json.loads(run("zx200", "target_excavate_pose", "--json").output)
    assert found["ok"] and found["subtask"] == "subtask_zx200_excavate_simple" and found["refusal"] is None
    (motion,) = found["motions"]
    assert len(motion["path"]) == 30 and motion["clearance"] == 0.42 and motion["notes"] == []


def test_a_refusal_is_told_with_exit_code_1(asked: list[str]) -> None:
    said = run("zx200", "opening")
    assert said.exit_code == 1 and "it would be refused: zx200:rc is still at its last goal" in said.output
    found = json.loads(run("zx200", "opening", "--json").output)
    assert found["refusal"]["code"] == "BUSY" and found["refusal"]["lasting"]


def test_a_record_that_fits_several_subtasks_needs_one_of_them(asked: list[str]) -> None:
    assert run("zx200", "another_dig").exception.reason.code == "WHICH_SUBTASK"  # type: ignore[union-attr]
    asked.clear()
    said = run("zx200", "another_dig", "--subtask", "subtask_zx200_change_pose")
    assert said.exit_code == 0 and asked == ["change_pose"]


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        (("ic120", "x"), "NO_PLANNED_ARM"),
        (("zx200", "flag"), "FOR_NO_ARM"),
        (("zx200", "flag", "--subtask", "subtask_zx200_release_simple"), "RECORD_UNFIT_FOR"),
        (("zx200", "flag", "--subtask", "fly"), "WHICH_SUBTASK"),
        (("zx999", "x"), "NO_MACHINE"),
        (("zx200", "missing"), "BUSY"),
    ],
)
def test_what_cannot_be_checked_says_why(asked: list[str], arguments: tuple[str, ...], code: str) -> None:
    failed = run(*arguments).exception
    assert isinstance(failed, TmsError) and failed.reason.code == code
    assert asked == []
