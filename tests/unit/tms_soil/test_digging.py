"""A zx200's bucket in the ground, and above it."""

import numpy as np
import pytest

from earth_rig import (
    ABOVE,
    HOLD,
    OPEN,
    START,
    Arm,
    dig_poses,
    flat,
    loading_site,
    model_of,
    moved,
    moved_by,
    reports,
    run,
    soils,
    vessel,
)
from tms_soil.capacity import Capacity
from tms_soil.digging import Digger
from tms_soil.earth import Earth
from tms_soil.grid import BANK, COMPACTED, LOOSE, Grid
from tms_soil.resistance import speed_share
from tms_soil.surface import Heights

MODELS = {"zx200": model_of("zx200")}
BUCKET = MODELS["zx200"].bucket
assert BUCKET is not None
SWUNG = ABOVE._replace(boom=HOLD[0], arm=HOLD[1], bucket=HOLD[2])


def digger(earth: Earth) -> Digger:
    found = earth.bodies["zx200"].digger
    assert found is not None
    return found


def layers(earth: Earth) -> np.ndarray:
    """Masses of the three layers [kg]."""
    window = earth.grid.window(earth.grid.bounds)
    assert window is not None
    sums: np.ndarray = window.layers.sum(axis=(1, 2)) * 0.01
    return sums


@pytest.mark.parametrize(("boom", "arm"), [(-0.25, 1.97), (-0.22, 1.9), (-0.27, 2.0)])
def test_a_pass_fills_the_bucket_as_its_class_says(boom: float, arm: float) -> None:
    earth = loading_site()
    before = earth.mass()
    run(earth, reports(moved(dig_poses(boom=boom, arm=arm))))
    assert 0.5 <= digger(earth).volume <= 0.9
    assert earth.mass() == pytest.approx(before, abs=1e-6)
    assert digger(earth).resistance == 0.0, "in the air"


def test_what_is_dug_swells() -> None:
    earth = loading_site()
    before = layers(earth)
    run(earth, reports(moved([*dig_poses(), ABOVE, OPEN])))
    after, soil = layers(earth), soils()[0]
    bank = (before - after)[BANK] / soil.bank
    loose = (after[LOOSE] + moved_by(earth, "zx200")) / soil.loose
    assert after[COMPACTED] == 0 and bank > 0.4
    assert loose == pytest.approx(bank * soil.swell, rel=1e-9)


def drag(*arms: float, boom: float = -0.25) -> list[Arm]:
    """The bucket's teeth down, through the ground towards the machine."""
    return [START._replace(boom=boom, arm=arm, bucket=0.3) for arm in arms]


def test_a_full_bucket_pushes_the_rest_before_it() -> None:
    earth = loading_site()
    run(earth, reports(moved(drag(1.0, 2.2))))
    most = soils()[0].fill * Capacity(BUCKET, soils()[0].repose_slope).heaped
    assert 0.5 < digger(earth).volume <= most
    assert layers(earth)[LOOSE] > 500, "a windrow"


def test_a_bucket_takes_nothing_in_by_its_back() -> None:
    earth = loading_site()
    run(earth, reports(moved(drag(2.2, 1.0))))
    assert digger(earth).volume == 0.0
    assert layers(earth)[LOOSE] > 500, "it pushes"


def test_a_dump_on_the_ground_is_a_pile_of_what_was_dug() -> None:
    earth = loading_site()
    before, flat = earth.mass(), earth.grid.heights().z
    end = run(earth, reports(moved([*dig_poses(), SWUNG, ABOVE])))
    dug = moved_by(earth, "zx200")
    end = run(earth, reports(moved([ABOVE, OPEN, OPEN, OPEN], end)))
    run(earth, reports((end + 0.02 * k, OPEN) for k in range(1, 150)))
    assert moved_by(earth, "zx200") == 0.0
    assert earth.mass() == pytest.approx(before, abs=1e-6)
    pile = earth.grid.heights((3, -3, 10, 3))
    risen = pile.z.sum() * pile.cell**2
    assert risen == pytest.approx(dug / soils()[0].loose, rel=1e-6)
    assert np.nanmax(earth.grid.heights().z - flat) > 0.2


def test_a_bucket_is_empty_two_seconds_after_it_opened() -> None:
    earth = loading_site()
    end = run(earth, reports(moved([*dig_poses(), SWUNG, ABOVE])))
    full = moved_by(earth, "zx200")
    end = run(earth, reports((end + 0.02 * k, OPEN) for k in range(10)))
    assert 0.3 * full < moved_by(earth, "zx200") < 0.9 * full, "it takes its time"
    run(earth, reports((end + 0.02 * k, OPEN) for k in range(100)))
    assert moved_by(earth, "zx200") == 0.0


def test_it_dumps_into_the_vessel_below() -> None:
    earth = loading_site()
    before = earth.mass()
    run(earth, [vessel(0.0, 0.0), *reports(moved([*dig_poses(), SWUNG, ABOVE, OPEN, OPEN]))])
    assert moved_by(earth, "zx200") < 0.03 * moved_by(earth, "ic120")
    assert earth.bodies["ic120"].hauler is not None and earth.bodies["ic120"].hauler.volume > 0.5
    assert earth.mass() == pytest.approx(before, abs=1e-6)


def test_two_reports_at_one_time_move_no_soil() -> None:
    earth = loading_site()
    end = run(earth, [vessel(0.0, 0.0), *reports(moved([*dig_poses(), SWUNG, ABOVE]))])
    tilted = ABOVE._replace(bucket=ABOVE.bucket - 0.7)
    run(earth, reports([(end + 0.02, tilted)]))
    before = moved_by(earth, "zx200")
    run(earth, reports([(end + 0.02, tilted)]))
    assert moved_by(earth, "zx200") == before > 0


def test_hard_ground_stalls_the_bucket_and_soft_ground_does_not() -> None:
    shares = {}
    for kind in ("sand", "earth", "clay", "soft_rock"):
        earth, least = loading_site(25.6, kind), 1.0
        for report in reports(moved(drag(1.1, 1.6, boom=-0.36))):
            earth.report(*report)
            least = min(least, speed_share(earth.bodies["zx200"].resistance, BUCKET.force))
        shares[kind] = least
    assert shares["sand"] > shares["earth"] > shares["clay"] > shares["soft_rock"] == 0.0
    assert shares["earth"] > 0.5


def test_unknown_ground_is_not_dug() -> None:
    level = flat()
    earth = Earth(Grid.from_heights(Heights(level.x0, level.y0, level.cell, level.z * np.nan), soils()), MODELS)
    run(earth, reports(moved(drag(1.0, 2.2))))
    assert moved_by(earth, "zx200") == 0.0
    assert earth.bodies["zx200"].resistance == 0.0


def test_a_bucket_that_stands_in_the_soil_meets_it_until_it_moves_out() -> None:
    earth = loading_site()
    body, log = earth.bodies["zx200"], list(reports(moved(dig_poses())))
    while body.resistance <= 5000.0:
        at = log.pop(0)
        earth.report(*at)
    met = body.resistance
    for k in (1, 2, 3):
        earth.report("zx200", at.time + 0.02 * k, at.angles, at.base)
        assert body.resistance == met, "stalled"
    for later in log:
        earth.report("zx200", later.time + 0.06, later.angles, later.base)
    assert body.resistance == 0.0
