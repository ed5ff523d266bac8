"""One bucket through the ground's own reckoning: what it digs is what its cycle and the carrier's cycle hold."""

import numpy as np
import pytest

from earth_rig import ABOVE, OPEN, START, dig_poses, loading_site, model_of, moved, reports, vessel
from tms_soil.digging import Digger
from tms_soil.earth import Earth
from tms_soil.hauling import Hauler
from tms_work.cycle import Cycle
from tms_work.recogniser import Recogniser
from tms_work.sample import Amount, Sample
from tms_work.ways import CARRIER, EXCAVATOR
from work_rig import BEGIN


def load(part: Digger | Hauler | None, earth: Earth) -> Amount:
    assert part is not None
    bank = sum(mass / soil.bank for mass, soil in zip(part.load, earth.grid.soils, strict=True))
    return Amount(float(part.load.sum()), float(bank), part.volume)


def test_a_bucket_dug_loaded_and_tipped() -> None:
    earth, cycles, swing = loading_site(), list[Cycle](), START.swing
    most = caught = 0.0  # kg in the bucket and in the vessel
    vessel_ = model_of("ic120").vessel
    assert vessel_ is not None
    excavator, carrier = Recogniser("zx200", EXCAVATOR, 0.9), Recogniser("ic120", CARRIER, vessel_.heaped)
    back = OPEN._replace(swing=-1.5)
    dig = [*reports(moved([*dig_poses(), ABOVE, *[OPEN] * 12, back], rate=25.0))]
    tip = [vessel(dig[-1].time + k / 25, -min(1.0, k / 50)) for k in range(1, 320)]
    for one in [vessel(0.0, 0.0), *dig, *tip]:
        earth.report(*one)
        zx200, ic120 = earth.bodies["zx200"], earth.bodies["ic120"]
        assert ic120.hauler is not None
        turn = one.angles.get("swing_joint", swing)
        speed, swing = (turn - swing) * 25.0, turn
        below = ic120.hauler.below(np.array([[6.5 * np.cos(turn), 6.5 * np.sin(turn), 4.0]]))
        sample = Sample(BEGIN + one.time, load(zx200.digger, earth), "r1", "earth", moves=True, swing=speed,
                        cuts=zx200.resistance > 0.0, under="ic120" if below else "")  # fmt: skip
        cycles += excavator.take(sample)
        most, caught = max(most, sample.load.mass), max(caught, float(ic120.hauler.load.sum()))
        cycles += carrier.take(Sample(sample.time, load(ic120.hauler, earth), "r1", "earth", moves=True))
    dug, hauled = cycles
    # What trickles before soil flows, and after, does not count.
    assert dug.mass == pytest.approx(most, rel=0.002)
    assert dug.loose == pytest.approx(dug.bank * earth.grid.soils[0].swell)
    assert dug.into == "ic120" and dug.parts.keys() == {"swing_back", "dig", "swing_loaded", "dump"}
    assert hauled.mass == pytest.approx(caught, rel=0.005) and 0.9 * dug.mass < caught < dug.mass
    assert hauled.buckets == 1 and hauled.into == ""
