"""A ground that is kept over a restart."""

import copy
import functools
import io

import numpy as np

from earth_rig import ABOVE, OPEN, dig_poses, flat, loading_site, model_of, moved, moved_by, reports, run, soils, vessel
from tms_soil.earth import Earth
from tms_soil.grid import Grid
from tms_soil.keeping import restore, state_of


@functools.cache
def _worked() -> Earth:
    earth = loading_site()
    run(earth, [vessel(0.0, 0.0), *reports(moved([*dig_poses(), ABOVE, OPEN, OPEN, *dig_poses(-1.2, now=OPEN)[1:]]))])
    return earth


def worked() -> Earth:
    return copy.deepcopy(_worked())


def test_it_comes_back_to_the_last_bit() -> None:
    earth, again, file = worked(), loading_site(), io.BytesIO()
    np.savez(file, **state_of(earth))  # type: ignore[arg-type]
    file.seek(0)
    with np.load(file) as state:
        assert restore(again, state)
    assert np.array_equal(again.grid.heights().z, earth.grid.heights().z)
    assert again.mass() == earth.mass()
    assert moved_by(again, "ic120") == moved_by(earth, "ic120") > 0 and moved_by(again, "zx200") > 0
    end = dig_poses(-1.2)[-1]
    for one in (earth, again):  # and it goes on in the same way
        one.bodies["zx200"].places = {}
        run(one, reports(moved(dig_poses(-1.4, now=end), 100.0)))
    assert np.array_equal(again.grid.heights().z, earth.grid.heights().z)


def test_what_is_kept_does_not_change_with_the_ground() -> None:
    earth = worked()
    state = state_of(earth)
    before = {name: one.copy() for name, one in state.items()}
    run(earth, reports(moved(dig_poses(-1.0), 100.0)))
    assert all(np.array_equal(state[name], one) for name, one in before.items())


def test_a_machine_that_is_gone_leaves_its_load_outside() -> None:
    earth = worked()
    left = Earth(Grid.from_heights(flat(25.6), soils()), {"zx200": model_of("zx200")})
    assert restore(left, state_of(earth))
    assert left.grid.outside == earth.grid.outside + moved_by(earth, "ic120") > 0
    assert left.mass() == earth.mass()


def test_a_ground_of_another_area_or_soil_is_not_taken() -> None:
    state = state_of(worked())
    other = {"zx200": model_of("zx200")}
    for earth in (loading_site(25.6, "sand"), Earth(Grid.from_heights(flat(12.8), soils()), other)):
        before = earth.mass()
        assert not restore(earth, state)
        assert earth.mass() == before
