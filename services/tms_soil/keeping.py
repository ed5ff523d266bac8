"""A ground and its loads as arrays by name, to keep them over a restart."""

from collections.abc import Mapping

import numpy as np

from tms_soil.earth import Earth
from tms_soil.surface import Array

TILE, LOAD, SITE, SOILS, OUTSIDE = "tile", "load", "site", "soils", "outside"  # names, or what they begin with
BY_TILE = "soils_by_tile"


def state_of(earth: Earth) -> dict[str, Array]:
    """All masses, and what they mean; later changes of the ground do not change it."""
    found = {f"{TILE} {row} {column}": layers.copy() for (row, column), layers in earth.grid.tiles.items()}
    found |= {f"{LOAD} {name}": body.load.copy() for name, body in earth.bodies.items() if body.load is not None}
    return found | _meaning(earth) | {OUTSIDE: np.array([earth.grid.outside])}


def restore(earth: Earth, state: Mapping[str, Array]) -> bool:
    """Bring a ground back; False if the state is of another area or of soils with other densities.

    Machines that have joined since are empty; what others carried that are gone counts as outside the site.
    """
    if not all(name in state and np.array_equal(state[name], one) for name, one in _meaning(earth).items()):
        return False
    earth.grid.outside = float(state[OUTSIDE][0])
    for name, masses in state.items():
        kind, _, rest = name.partition(" ")
        if kind == TILE:
            row, column = map(int, rest.split())
            earth.grid.put_back((row, column), masses)
        elif kind == LOAD and (load := earth.bodies[rest].load if rest in earth.bodies else None) is not None:
            load[:] = masses
        elif kind == LOAD:
            earth.grid.outside += float(masses.sum())
    return True


def _meaning(earth: Earth) -> dict[str, Array]:
    x0, y0, x1, y1 = earth.grid.bounds
    kinds = earth.grid.thickness.copy()
    found = {SITE: np.array([x0, y0, x1, y1, earth.grid.datum]), SOILS: kinds}
    return found | ({BY_TILE: earth.grid.soil_of.astype(np.float64)} if len(earth.grid.soils) > 1 else {})
