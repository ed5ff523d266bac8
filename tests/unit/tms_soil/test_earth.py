"""The whole ground with its machines: nothing is lost, the same reports give the same ground, cycles fill a truck."""

import math

import numpy as np
import pytest
from hypothesis import Phase, given, settings

from earth_rig import (
    ABOVE,
    OPEN,
    START,
    Report,
    cycles,
    dig_poses,
    loading_site,
    mass_error,
    moved,
    moved_by,
    placed,
    reports,
    run,
    truckload,
    vessel,
)
from tms_soil.earth import GAP

PHASES = [phase for phase in Phase if phase is not Phase.shrink]  # which takes minutes here


@settings(max_examples=10, deadline=None, phases=PHASES)
@given(cycles(3))
def test_nothing_is_lost_whatever_machines_do(log: list[Report]) -> None:
    assert mass_error(log) <= 1e-9


def test_the_same_reports_give_the_same_ground() -> None:
    log = [vessel(0.0, 0.0), *reports(moved([*dig_poses(), ABOVE])), vessel(30.0, -1.0)]
    first, second = loading_site(), loading_site()
    run(first, log)
    run(second, log)
    assert np.array_equal(first.grid.heights().z, second.grid.heights().z)
    assert moved_by(first, "zx200") == moved_by(second, "zx200") > 0


@pytest.mark.parametrize("rate", [16.67, 25.0])
def test_slower_reports_give_nearly_the_same(rate: float) -> None:
    volumes = []
    for each in (50.0, rate):
        earth = loading_site()
        run(earth, reports(moved(dig_poses(), rate=each)))
        volumes.append(moved_by(earth, "zx200"))
    assert volumes[1] == pytest.approx(volumes[0], rel=0.03)


def test_a_stand_in_that_lives_fast_jumps_nowhere() -> None:
    """At ten times its speed it tells 2.5 times in a second of its own where it is: its bucket is a metre on."""
    earth = loading_site()
    low = START._replace(boom=-0.25, arm=1.0, bucket=0.3)
    run(earth, reports([(0.0, low), (0.4, low._replace(arm=1.44))]))
    assert moved_by(earth, "zx200") > 0.0


@pytest.mark.turns
def test_seven_to_nine_passes_fill_a_truck() -> None:
    earth = loading_site()
    before = earth.mass()
    passes = truckload(earth)
    assert all(0.5 <= volume <= 0.9 for volume in passes[:-1])
    assert 7 <= len(passes) <= 9
    assert earth.mass() == pytest.approx(before, abs=1e-6)


@pytest.mark.parametrize("seconds", [-5.0, GAP + 0.1], ids=["a clock that goes back", "a long silence"])
def test_nobody_knows_what_it_did_meanwhile(seconds: float) -> None:
    earth = loading_site()
    low = START._replace(boom=-0.25, arm=1.0, bucket=0.3)
    run(earth, reports([(10.0, low)]))
    assert earth.report(*next(reports([(10.0 + seconds, low._replace(arm=1.06))]))) == []
    assert moved_by(earth, "zx200") == 0.0
    run(earth, reports([(10.02 + seconds, low._replace(arm=1.12))]))
    assert moved_by(earth, "zx200") > 0.0, "it goes on"


def test_a_machine_that_is_put_elsewhere_digs_nothing_on_the_way() -> None:
    earth = loading_site()
    low = START._replace(boom=-0.25, arm=1.0, bucket=0.3)
    run(earth, reports([(0.0, low)]))
    run(earth, reports([(0.02, low)], placed(0.0, 3.0, 0.0)))
    assert moved_by(earth, "zx200") == 0.0


def test_a_machine_that_rests_costs_nothing() -> None:
    earth = loading_site()
    end = run(earth, reports(moved(dig_poses())))
    last = dig_poses()[-1]
    found = [earth.report(*one) for one in reports((end + 0.02 * k, last) for k in range(1, 200))]
    assert found[-1] == [] and earth.bodies["zx200"].rests
    assert not earth.bodies["zx200"].running


def test_a_report_tells_where_the_ground_changed() -> None:
    earth = loading_site()
    before, changed = earth.grid.heights().z, []
    for one in reports(moved(dig_poses())):
        changed += earth.report(*one)
    x, y = earth.grid.heights().centres
    inside = np.zeros(x.shape, dtype=bool)
    for x0, y0, x1, y1 in changed:
        inside |= (x >= x0 - 0.5) & (x <= x1 + 0.5) & (y >= y0 - 0.5) & (y <= y1 + 0.5)
    touched = earth.grid.heights().z != before
    assert touched.any() and not (touched & ~inside).any()
    assert math.hypot(x[touched].mean(), y[touched].mean() + 4.9) < 0.5, "where it dug"


def test_a_truck_hauls_its_load() -> None:
    earth = loading_site()
    run(earth, [vessel(0.0, 0.0), *reports(moved([*dig_poses(), ABOVE, OPEN, OPEN]))])
    load = moved_by(earth, "ic120")
    places = [placed(6.5 - 0.02 * k, -0.01 * k, 0.0) for k in range(200)]
    run(earth, (vessel(30 + 0.02 * k, 0.0, place) for k, place in enumerate(places)))
    assert moved_by(earth, "ic120") == load > 0
    tips = [max(-1.1, -0.006 * k) for k in range(700)]
    run(earth, (vessel(40 + 0.02 * k, angle, places[-1]) for k, angle in enumerate(tips)))
    assert moved_by(earth, "ic120") < 0.02 * load
    pile = earth.grid.heights((-2, -4, 2, 0)).z
    assert pile.max() > 0.1, "behind it"


def test_where_parts_are_is_known_while_a_machine_stands() -> None:
    body = loading_site().bodies["zx200"]
    angles, base = (
        {"swing_joint": 0.0, "boom_joint": -0.5, "arm_joint": 1.2, "bucket_joint": 0.4},
        placed(1.0, 2.0, 0.3),
    )
    first = body.at(angles, base)
    assert body.at(dict(angles), base) is first
    angles["arm_joint"] += 0.01
    bent = body.at(angles, base)
    assert not np.array_equal(bent["digger"], first["digger"])
    moved_on = body.at(angles, placed(1.0, 2.1, 0.3))
    assert moved_on["digger"][1, 3] == pytest.approx(bent["digger"][1, 3] + 0.1)
    again = body.at({**angles, "arm_joint": 1.2}, base)
    assert all(np.array_equal(again[part], first[part]) for part in first)
