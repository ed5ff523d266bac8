"""`tms:ground` without processes: what machines publish becomes volumes, and a file."""

from copy import deepcopy
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import structlog
from builtin_interfaces.msg import Time
from geometry_msgs.msg import TransformStamped
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64
from tf2_msgs.msg import TFMessage
from tms_msg_ground.srv import GetHeights

from earth_rig import dig_poses, moved, reports
from tms_config.config import load_site
from tms_ground import node
from tms_ground.heights import SERVICE
from tms_ground.reasons import BadCell, GroundDamaged, GroundOther, NotAnArea
from tms_ground.telling import PATCHES
from tms_reason.wire import refusal
from tms_soil.patches import heights
from tms_soil.surface import Heights

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
        self.published: dict[str, list[Any]] = {}
        self.services: dict[str, Any] = {}
        self.steps: dict[str, Any] = {}
        self.stops: list[Any] = []
        self.app: Any = SimpleNamespace(
            site=load_site(str(folder / "site.yaml")),
            ros=SimpleNamespace(
                sample=lambda _, topic, depth=1: lambda: self.waiting.pop(topic, [])[-depth:],
                subscribe=lambda *_, **__: None,
                publisher=self.publisher,
                now=lambda: Time(sec=int(self.now)),
                offer_slow=lambda _, name, handler: self.services.update({name: handler}),
                prepare=lambda *_: None,
                poll_in_thread=lambda _, step, name: self.steps.update({name: step}),
            ),
            log=structlog.stdlib.get_logger("test"),
            on_stop=self.stops.append,
            ready_when=lambda _: None,
        )

    def publisher(self, kind: type, topic: str, depth: int, latched: bool = False) -> Any:
        told = self.published.setdefault(topic, [])

        def publish(message: Any) -> None:
            assert type(message) is kind
            told.append(message.data if kind is Float64 else deepcopy(message))

        return SimpleNamespace(publish=publish)

    def run(self, late: int = 1) -> None:
        """A pass of the excavator; of so many joint states one look finds all."""
        base = TransformStamped(child_frame_id="zx200/base_link")
        base.header.frame_id, base.transform.rotation.w = "map", 1.0
        for number, report in enumerate(reports(moved(dig_poses(), rate=25.0))):
            self.waiting["/tf"] = [TFMessage(transforms=[base])]
            angles = dict(report.angles)
            told = JointState(name=list(angles), position=list(angles.values()))
            self.waiting.setdefault("/zx200/joint_states", []).append(told)
            if number % late == 0:
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


@pytest.mark.parametrize("late", [8, 100])
def test_a_look_that_comes_late_takes_all_that_was_told(
    late: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    world = World(tmp_path, monkeypatch)
    node.start(world.app)
    taken = node.REPORTS.labels("zx200").collect()[0].samples[0]
    world.run(late)
    world.steps["ground"]()
    more = node.REPORTS.labels("zx200").collect()[0].samples[0].value - taken.value
    assert more == pytest.approx(len(list(moved(dig_poses(), rate=25.0))), abs=1)


def asked(world: World, **request: float) -> GetHeights.Response:
    return world.services[SERVICE](GetHeights.Request(**request), GetHeights.Response())


def test_a_load_has_mass_volumes_and_its_soil(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    world = World(tmp_path, monkeypatch)
    node.start(world.app)
    world.run()
    first, last = (world.published["/zx200/soil_load"][k] for k in (0, -1))
    assert (first.soil, first.mass, first.measured) == ("", 0.0, False)
    assert first.capacity == last.capacity == pytest.approx(0.9, abs=0.15)
    assert last.soil == "earth" and not last.measured
    assert last.loose == world.published["/zx200/soil_volume"][-1]
    assert last.loose / last.bank == pytest.approx(1.25, abs=0.06), "the swell of earth"
    assert 1000 < last.mass / last.loose < 1600, "kg/m3"
    empty = world.published["/ic120/soil_load"][-1]
    assert empty.mass == 0.0 and 5.0 < empty.capacity < 7.0


def test_who_collects_the_patches_has_the_ground(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    world = World(tmp_path, monkeypatch)
    node.start(world.app)
    before = asked(world, cell=0.1)
    assert not before.error_code and before.ground.header.frame_id == "map"
    mine = heights(before.ground)
    assert not mine.z.any() and np.isnan(before.ages).all()
    world.run()
    for _ in range(20):  # until all is told
        world.now += node.TELLS
        world.steps["ground"]()
    told = world.published[PATCHES]
    assert [one.serial for one in told] == list(range(before.ground.serial + 1, before.ground.serial + 1 + len(told)))
    for message in told:
        part = heights(message)
        assert part.cell == 0.1
        row, column = (round((a - b) / 0.1) for a, b in ((part.y0, mine.y0), (part.x0, mine.x0)))
        mine.z[row : row + part.z.shape[0], column : column + part.z.shape[1]] = part.z
    after = asked(world, cell=0.1)
    assert after.ground.serial == told[-1].serial
    assert np.array_equal(mine.z, heights(after.ground).z), "somebody was not told of a change"
    assert mine.z.min() < -0.3
    ages = np.array(after.ages).reshape(mine.z.shape)
    assert np.isfinite(ages[mine.z < -0.1]).all() and np.isnan(ages[:10]).all()


def test_a_machine_of_a_simulated_site_feels_the_soil_and_how_it_stands(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    world = World(tmp_path, monkeypatch, GROUND.replace("ground: {", "ground: {level: 1.5, "))
    node.start(world.app)
    world.run()
    felt = world.published["/zx200/ground_contact"]
    assert felt[0].resistance == 0.0 and max(one.resistance for one in felt) > 2000
    assert felt[0].stands.position.z == pytest.approx(1.5) and felt[0].stands.orientation.w == pytest.approx(1.0)
    real = World(tmp_path, monkeypatch, GROUND + "backend: opera\n")
    node.start(real.app)
    assert "/zx200/ground_contact" not in real.published, "a real machine feels it itself"


@pytest.mark.parametrize("cell", [0.1, 0.2, 0.25, 1.0])
def test_a_rectangle_with_its_design(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, cell: float) -> None:
    pit = "design: {pit: {floor: [[-2, -2], [2, -2], [2, 2], [-2, 2]], level: -1, rim: 0.5, slope: 0.5}}"
    world = World(tmp_path, monkeypatch, GROUND.replace("ground: {", f"ground: {{level: 0.5, {pit}, "))
    node.start(world.app)
    found = asked(world, x0=-3.0, y0=-1.0, x1=3.0, y1=30.0, cell=cell)
    ground = heights(found.ground)
    x0, y0, x1, y1 = ground.bounds
    assert (x0, y0, x1) == (pytest.approx(-3.0), pytest.approx(-1.0), pytest.approx(3.0, abs=cell))
    assert 10.0 - 1e-6 <= y1 < 10.0 + cell, "as far as the site reaches"
    assert ground.z == pytest.approx(0.5)
    design = Heights(x0, y0, cell, np.array(found.design).reshape(ground.z.shape))
    assert design.at(np.array([0.0, 0.0]), np.array([0.0, 3.5])) == pytest.approx([-1.0, -0.25], abs=0.02)
    assert np.isnan(design.at(np.array([0.0]), np.array([8.0]))[0])


@pytest.mark.parametrize(("request_", "reason"), [
    ({"x0": 20.0, "x1": 30.0, "y0": 0.0, "y1": 1.0}, NotAnArea), ({"x0": 1.0, "x1": -1.0, "y1": 1.0}, NotAnArea),
    ({"x0": float("nan"), "x1": 1.0, "y1": 1.0}, NotAnArea), ({"cell": 0.01}, BadCell), ({"cell": -1.0}, BadCell),
    ({"cell": float("nan")}, BadCell), ({"cell": 50.0}, BadCell),
])  # fmt: skip
def test_what_is_no_rectangle_of_the_site_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, request_: dict[str, float], reason: type
) -> None:
    world = World(tmp_path, monkeypatch)
    node.start(world.app)
    found = asked(world, **request_)
    assert isinstance(refusal(found.error_code, found.error_msg), reason) and not found.ground.heights


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
    assert isinstance(line["reason"], GroundDamaged if damaged else GroundOther)
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
