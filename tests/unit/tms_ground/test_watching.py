"""What machines tell becomes a ground, and is kept."""

import math
from pathlib import Path

import numpy as np
import pytest

from earth_rig import dig_poses, model_of, moved, reports, soils
from tms_ground.settings import Ground
from tms_ground.watching import GroundWatch, touching
from tms_machine.frames import FramePose

AREA = (-10.0, -10.0, 10.0, 10.0)
PLACE = FramePose(0.0, 0.0, 0.0, 0.0)


def watch(folder: Path, **ground: object) -> GroundWatch:
    settings = Ground.model_validate({"area": AREA, **ground})
    return GroundWatch(settings, {"earth": soils()[0]}, {"zx200": model_of("zx200")}, folder / "ground.npz")


def save(one: GroundWatch) -> None:
    content = one.content()
    assert content is not None
    one.file.write_bytes(content.ground)


def dig(one: GroundWatch) -> None:
    for report in reports(moved(dig_poses(), rate=25.0)):
        one.take("zx200", report.time, report.angles, PLACE)


def test_a_machine_digs_in_the_ground_that_it_stands_on(tmp_path: Path) -> None:
    one = watch(tmp_path, level=12.0)
    dig(one)
    assert 0.5 < one.loads()["zx200"].loose < 0.9
    lowest = np.nanmin(one.earth.grid.heights().z)
    assert 11.0 < lowest < 11.7
    assert abs(one.mass_error) < 1e-6


def test_it_goes_on_after_a_restart(tmp_path: Path) -> None:
    one = watch(tmp_path)
    assert not one.load(), "the first start"
    assert one.content() is None, "nothing has changed"
    dig(one)
    save(one)
    assert one.content() is None
    again = watch(tmp_path)
    assert again.load()
    assert again.loads() == one.loads()
    assert np.array_equal(again.earth.grid.heights().z, one.earth.grid.heights().z, equal_nan=True)
    assert again.mass_error == 0.0
    assert not watch(tmp_path, soil="sand", level=3.0).load(), "another level is another ground"


def test_a_damaged_file_is_told(tmp_path: Path) -> None:
    one = watch(tmp_path)
    one.file.write_bytes(b"PK\x03\x04 cut off")
    with pytest.raises((ValueError, OSError)):
        one.load()
    one.file.write_bytes(b"")
    with pytest.raises((ValueError, OSError)):
        one.load()


def test_only_machines_with_a_shape_touch_the_ground() -> None:
    bare = model_of("ic120").model_copy(update={"vessel": None, "tracks": None})
    assert touching({"a": bare, "b": model_of("d37pxi"), "c": model_of("ic120")}).keys() == {"b", "c"}


def test_the_soil_is_that_of_the_region_where_it_is_dug(tmp_path: Path) -> None:
    corners = ((-30.0, -30.0), (30.0, -30.0), (30.0, 0.0), (-30.0, 0.0))
    settings = Ground.model_validate(
        {"area": (-25.6, -25.6, 25.6, 25.6), "soils": ({"soil": "sand", "corners": corners},)}
    )
    known = dict(zip(("earth", "sand"), soils("earth", "sand"), strict=True))

    def made(ground: Ground) -> GroundWatch:
        return GroundWatch(ground, known, {"zx200": model_of("zx200")}, tmp_path / "ground.npz")

    kinds = []
    for yaw in (0.0, math.pi):  # it digs to its right: at y < 0, then at y > 0
        one = made(settings)
        for report in reports(moved(dig_poses(), rate=25.0)):
            one.take("zx200", report.time, report.angles, FramePose(0.0, 0.0, yaw, 0.0))
        kind = one.loads()["zx200"].kind
        assert kind is not None
        kinds.append(one.soils[kind])
    assert kinds == ["sand", "earth"]
    save(one)
    assert made(settings).load()
    assert not made(settings.model_copy(update={"soils": ()})).load(), "other soils lie there now"


def test_a_turned_machine_digs_beside_itself(tmp_path: Path) -> None:
    one = watch(tmp_path)
    for report in reports(moved(dig_poses(), rate=25.0)):
        one.take("zx200", report.time, report.angles, FramePose(1.0, 2.0, math.pi / 2, 0.0))
    heights = one.earth.grid.heights()
    x, y = heights.centres
    hole = heights.z < -0.3
    assert x[hole].mean() == pytest.approx(1.0 + 5.3, abs=0.7) and y[hole].mean() == pytest.approx(2.0, abs=0.3)
