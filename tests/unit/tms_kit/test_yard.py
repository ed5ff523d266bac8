"""What a subtask learns of the machines and the ground around: as told now, or who does not tell it."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from tms_msg_ground.msg import SoilLoad
from tms_msg_ground.srv import GetHeights

from tms_config.config import load_site
from tms_kit import yard
from tms_kit.yard import Yard
from tms_machine.stamps import time
from tms_reason.errors import SubtaskFailed
from tms_soil import patches
from tms_soil.surface import Heights

SITE = """
name: t
domain: 43
services: {db: {}}
machines: {zx200: {model: zx200}, ic120: {model: ic120}, d37pxi: {model: d37pxi}}
ground: {area: [-10, -10, 10, 10]}
"""
NOW = 1.8e9  # s since 1970
LEVEL = Heights(0.0, 0.0, 0.2, np.zeros((2, 3)))


@pytest.fixture
def world(tmp_path: Any, monkeypatch: pytest.MonkeyPatch) -> Any:
    """A ROS whose loads come one a look; time passes by looks only."""
    (tmp_path / "site.yaml").write_text(SITE)
    monkeypatch.setenv("TMS_STATE", str(tmp_path / "state"))
    told: dict[str, list[SoilLoad]] = {}
    world = SimpleNamespace(now=0.0, told=told, design=[], served=True, checks=0)

    def let_time_pass(seconds: float) -> None:
        world.now += seconds

    def check() -> None:
        world.checks += 1

    monkeypatch.setattr(yard, "monotonic", lambda: world.now)
    monkeypatch.setattr(yard, "unix_time", lambda: NOW)
    monkeypatch.setattr(yard, "sleep", let_time_pass)
    monkeypatch.setattr(yard, "Places", lambda *_: SimpleNamespace(take=lambda: None, place=lambda _: None))
    ros: Any = SimpleNamespace(
        sample=lambda _, topic: lambda: [told[topic].pop(0)] if told.get(topic) else [],
        has_service=lambda *_: world.served,
        call=lambda *_: GetHeights.Response(ground=patches.patch(LEVEL), design=world.design),
    )
    world.check, world.yard = check, Yard(ros, load_site(str(tmp_path / "site.yaml")))
    return world


def loads(*volumes: float, late: float = 0.0) -> list[SoilLoad]:
    return [SoilLoad(loose=loose, stamp=time(NOW - late)) for loose in volumes]


def test_only_a_load_that_is_told_after_the_call_counts(world: Any) -> None:
    world.told |= {"/zx200/soil_load": loads(0.1, 0.7), "/ic120/soil_load": loads(1.0, 2.0)}
    found = world.yard.loads(["zx200", "ic120"], world.check)
    assert [one.loose for one in found] == [0.7, 2.0]


def test_what_a_late_ground_tells_after_the_call_does_not_count(world: Any) -> None:
    world.told |= {"/zx200/soil_load": [*loads(0.1), *loads(0.2, 0.3, late=0.5), *loads(0.7)]}
    (found,) = world.yard.loads(["zx200"], world.check)
    assert found.loose == 0.7, "it has taken what the machine did before the call"


def test_a_load_that_nobody_tells_fails_it_in_the_end(world: Any) -> None:
    world.told |= {"/ic120/soil_load": loads(1.0, 2.0)}
    with pytest.raises(SubtaskFailed, match=r"LOAD_NOT_TOLD.*zx200"):
        world.yard.loads(["ic120", "zx200"], world.check)
    assert world.now >= yard.COMES_BACK and world.checks > 2, "a cancel is heard meanwhile"
    with pytest.raises(SubtaskFailed, match=r"LOAD_NOT_TOLD.*d37pxi"):
        world.yard.loads(["d37pxi"], world.check)


def test_without_a_place_it_is_told_whose(world: Any) -> None:
    with pytest.raises(SubtaskFailed, match=r"PLACE_NOT_TOLD.*ic120"):
        world.yard.place("ic120", world.check)
    assert world.yard.taken("zx200") == []


def test_the_design_counts_where_there_is_one_and_the_floor_everywhere(world: Any) -> None:
    ground, wanted = world.yard.ground((0.0, 0.0, 0.6, 0.4), -1.0, world.check)
    assert np.array_equal(ground.z, LEVEL.z)
    assert (wanted.z == -1.0).all(), "no design: the floor"
    world.design = [-0.5, -2.0, np.nan, -0.5, -2.0, np.nan]
    _, wanted = world.yard.ground((0.0, 0.0, 0.6, 0.4), -1.0, world.check)
    assert np.array_equal(wanted.z, [[-0.5, -1.0, np.nan]] * 2, equal_nan=True), "nothing where the design is silent"


def test_it_waits_for_the_ground(world: Any) -> None:
    world.served = False
    with pytest.raises(SubtaskFailed, match=r"WAITING_FOR.*tms:ground"):
        world.yard.ground((0.0, 0.0, 1.0, 1.0), 0.0, world.check)
    assert world.now >= yard.COMES_BACK
