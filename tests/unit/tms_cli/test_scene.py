"""`tms scene` shows what an excavator's planner keeps clear of."""

import json
from collections.abc import Iterator
from contextlib import contextmanager
from types import SimpleNamespace
from typing import Any

import pytest
from click.testing import CliRunner, Result
from geometry_msgs.msg import Point, Vector3
from tms_msg_rp.msg import SceneArea, SceneBody
from tms_msg_rp.srv import GetScene

from tms_cli import session
from tms_cli.main import tms
from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_reason.wire import to_line
from tms_rp.reasons import PartOf

MODELS = {name: parse(CONFIGS / "machines" / f"{name}.yaml", MachineModel) for name in ("zx200", "ic120")}


@pytest.fixture(autouse=True)
def asked(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    services: list[str] = []

    def answer(_: Any, kind: Any, service: str) -> GetScene.Response:
        assert kind is GetScene
        services.append(service)
        body = SceneBody(kind="machine", name=to_line(PartOf("vessel", "ic120_1")), margin=0.5, age=3.0,
                         size=Vector3(x=2.0, y=2.0, z=4.0), triangles=[Point()] * 3)  # fmt: skip
        body.pose.position.x = 8.0
        area = SceneArea(record="dig", centre=Point(x=5.0), size=Vector3(x=2.0, y=1.0, z=0.5))
        return GetScene.Response(bodies=[body], areas=[area], way=[Point(x=6.0)])

    @contextmanager
    def ros() -> Iterator[None]:
        yield None

    machines = {name: SimpleNamespace(model=name) for name in MODELS}
    site = SimpleNamespace(file=SimpleNamespace(machines=machines), model_of=MODELS.__getitem__)
    monkeypatch.setattr(session, "ros", ros)
    monkeypatch.setattr(session, "site", lambda: site)
    monkeypatch.setattr(session, "call", answer)
    return services


def run(*arguments: str) -> Result:
    return CliRunner().invoke(tms, ["scene", *arguments])


def test_a_line_for_each_body_and_area(asked: list[str]) -> None:
    said = run("zx200")
    assert said.exit_code == 0 and asked == ["/zx200/rp/get_scene"]
    _, body, area = said.output.splitlines()
    assert body.split() == ["machine", "8.00", "0.00", "0.00", *"2.00 x 2.00 x 4.00".split(), "0.50", "3.0", "s",
                            *"vessel of ic120_1".split()]  # fmt: skip
    assert area.split()[0] == "area" and area.split()[-1] == "dig"


def test_as_json() -> None:
    found = json.loads(run("zx200", "--json").output)
    assert found["bodies"][0] | {"name": ""} == {
        "kind": "machine", "name": "", "position": [8.0, 0.0, 0.0], "orientation": [0.0, 0.0, 0.0, 1.0],
        "size": [2.0, 2.0, 4.0], "margin": 0.5, "age": 3.0, "triangles": 1,
    }  # fmt: skip
    assert found["areas"] == [{"record": "dig", "centre": [5.0, 0.0, 0.0], "size": [2.0, 1.0, 0.5]}]
    assert found["way"] == [[6.0, 0.0, 0.0]]


def test_a_machine_without_a_planner_has_none(asked: list[str]) -> None:
    said = run("ic120")
    assert said.exit_code != 0 and said.exception.reason.code == "NO_PLANNED_ARM"  # type: ignore[union-attr]
    assert asked == []
