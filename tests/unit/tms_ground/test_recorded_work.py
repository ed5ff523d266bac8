"""The log of stand-ins in a mesh becomes the cycles that they were told to make: two buckets, and one load tipped.

tests/data/loading_and_hauling.csv has joints [rad], the carrier's place [m, rad] and what the gateways told, five times
a second of a run at real speed; the zx200 stood at the origin of map.
"""

import csv
from pathlib import Path

import pytest

from conftest import PROJECT
from earth_rig import NAMES, model_of, soils
from tms_ground.settings import Ground
from tms_ground.watching import GroundWatch
from tms_ground.work import Duty
from tms_machine.frames import FramePose
from tms_work.cycle import Cycle

LOG = PROJECT / "tests" / "data" / "loading_and_hauling.csv"
BEGIN = 1.8e9  # s since 1970


@pytest.fixture(scope="module")
def cycles(tmp_path_factory: pytest.TempPathFactory) -> list[Cycle]:
    models = {"zx200": model_of("zx200"), "ic120": model_of("ic120")}
    ground = Ground(area=(-13.0, -13.0, 26.0, 13.0))
    watch, found = (
        GroundWatch(ground, {"earth": soils()[0]}, models, Path(tmp_path_factory.mktemp("ground")) / "g"),
        list[Cycle](),
    )
    for row in csv.DictReader(LOG.read_text(encoding="utf-8").splitlines()):
        time = float(row["time"])
        arm = {name: float(row[name.removesuffix("_joint")]) for name in NAMES}
        stands = FramePose(float(row["x"]), float(row["y"]), float(row["yaw"]), 0.0)
        for machine, angles, place in (
            ("zx200", arm, FramePose(0.0, 0.0, 0.0, 0.0)), ("ic120", {"vessel_pin_joint": float(row["vessel"])}, stands)
        ):  # fmt: skip
            watch.take(machine, time, angles, place)
            duty = Duty(row["run"], row[f"{machine}_moves"] == "1")
            found += watch.count(machine, BEGIN + time, angles, place, duty)
    assert abs(watch.mass_error) < 1e-6
    return found


def test_the_buckets_are_found(cycles: list[Cycle]) -> None:
    first, second = (one for one in cycles if one.kind == "dig")
    assert [(one.machine, one.into, one.soil, one.run_id) for one in (first, second)] == [
        ("zx200", "ic120", "earth", "r1")
    ] * 2
    # What `tms:ground` counted in that mesh, at 25 Hz.
    assert (first.loose, second.loose) == pytest.approx((0.707, 0.546), rel=0.05)
    assert first.parts == pytest.approx(
        {"swing_back": 10.0, "wait_for_truck": 27.1, "dig": 7.9, "swing_loaded": 4.7, "dump": 2.6}, abs=0.7
    )
    assert second.parts == pytest.approx({"swing_back": 6.7, "dig": 7.6, "swing_loaded": 4.9, "dump": 2.5}, abs=0.7)
    assert second.seconds == pytest.approx(21.6, abs=0.7)


def test_the_load_is_found(cycles: list[Cycle]) -> None:
    dug, (hauled,) = [one for one in cycles if one.kind == "dig"], [one for one in cycles if one.kind == "haul"]
    assert hauled.buckets == 2 and hauled.into == ""
    whole = sum(one.mass for one in dug)
    assert 0.93 * whole < hauled.mass <= whole, "some falls beside the vessel"
    assert hauled.distance == pytest.approx(5.5 + 13.5, abs=0.5), "from where it stood, to be loaded, to tip"
    assert hauled.parts == pytest.approx(
        {"wait": 23.9, "return": 26.1, "load": 25.9, "haul": 16.8, "tip": 9.7}, abs=1.0
    )
