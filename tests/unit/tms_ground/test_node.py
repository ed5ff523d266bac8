"""`tms:ground` without processes: what machines publish becomes volumes, and a file."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
import structlog
from geometry_msgs.msg import TransformStamped
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64
from tf2_msgs.msg import TFMessage

from earth_rig import dig_poses, moved, reports
from tms_config.config import load_site
from tms_ground import node
from tms_ground.reasons import GroundNotKept, GroundOther

SITE = """
name: t
domain: 43
services: {db: {}}
machines: {zx200: {model: zx200}, ic120: {model: ic120}}
"""
GROUND = "ground: {area: [-10, -10, 10, 10]}\n"


class World:
    """A ROS in which messages lie ready until they are taken."""

    def __init__(self, folder: Path, monkeypatch: pytest.MonkeyPatch, ground: str = GROUND) -> None:
        monkeypatch.setenv("TMS_STATE", str(folder / "state"))
        monkeypatch.setattr(node, "monotonic", lambda: self.now)
        (folder / "site.yaml").write_text(SITE + ground)
        self.now = 100.0
        self.waiting: dict[str, list[Any]] = {}
        self.published: dict[str, list[float]] = {}
        self.steps: dict[str, Any] = {}
        self.stops: list[Any] = []
        self.app: Any = SimpleNamespace(
            site=load_site(str(folder / "site.yaml")),
            ros=SimpleNamespace(
                sample=lambda _, topic, *__: lambda: self.waiting.pop(topic, []),
                subscribe=lambda *_, **__: None,
                publisher=self.publisher,
                poll_in_thread=lambda _, step, name: self.steps.update({name: step}),
            ),
            log=structlog.stdlib.get_logger("test"),
            on_stop=self.stops.append,
            ready_when=lambda _: None,
        )

    def publisher(self, kind: type, topic: str, depth: int) -> Any:
        assert kind is Float64 and depth == 1
        told = self.published.setdefault(topic, [])
        return SimpleNamespace(publish=lambda message: told.append(message.data))

    def run(self) -> None:
        """A pass of the excavator."""
        base = TransformStamped(child_frame_id="zx200/base_link")
        base.header.frame_id, base.transform.rotation.w = "map", 1.0
        for report in reports(moved(dig_poses(), rate=25.0)):
            self.waiting["/tf"] = [TFMessage(transforms=[base])]
            angles = dict(report.angles)
            self.waiting["/zx200/joint_states"] = [JointState(name=list(angles), position=list(angles.values()))]
            self.steps["ground"]()
            self.now += 0.04


def test_a_pass_is_told_and_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    world = World(tmp_path, monkeypatch)
    node.start(world.app)
    world.run()
    told = world.published["/zx200/soil_volume"]
    assert told[0] == 0.0 and 0.5 < told[-1] < 0.9
    assert len(told) == pytest.approx((world.now - 100.0) / node.TELLS, abs=2)
    assert set(world.published["/ic120/soil_volume"]) == {0.0}, "nobody has told where it is"
    for stop in world.stops:
        stop()
    again = World(tmp_path, monkeypatch)
    node.start(again.app)
    again.steps["ground"]()
    assert again.published["/zx200/soil_volume"][-1] == pytest.approx(told[-1], abs=0.01)


@pytest.mark.parametrize("damaged", [True, False], ids=["damaged", "of another level"])
def test_a_kept_ground_that_does_not_fit_is_put_aside(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, damaged: bool
) -> None:
    world = World(tmp_path, monkeypatch)
    node.start(world.app)
    world.run()
    world.stops[0]()
    file = world.app.site.state / "ground.npz"
    if damaged:
        file.write_bytes(file.read_bytes()[:1000])
    other = World(tmp_path, monkeypatch, GROUND if damaged else GROUND.replace("ground: {", "ground: {level: 2.5, "))
    with structlog.testing.capture_logs() as logs:
        node.start(other.app)
    (line,) = (one for one in logs if one["event"] == "ground_begins_anew")
    assert isinstance(line["reason"], GroundNotKept if damaged else GroundOther)
    assert not file.exists() and file.with_name(file.name + ".unreadable").exists()
    other.steps["ground"]()
    assert other.published["/zx200/soil_volume"] == [0.0]


def test_it_saves_now_and_then_and_a_full_disk_ends_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    world = World(tmp_path, monkeypatch)
    node.start(world.app)
    file, save = world.app.site.state / "ground.npz", world.steps["ground_file"]
    save()
    assert not file.exists(), "nothing has changed"
    world.run()
    with monkeypatch.context() as disk, structlog.testing.capture_logs() as logs:
        disk.setattr("tms_runtime.durable.replace", full)
        save()
    assert [one["event"] for one in logs] == ["ground_not_saved"]
    save()
    assert file.exists(), "it tries again"


def full(*_: object) -> None:
    raise OSError(28, "No space left on device")
