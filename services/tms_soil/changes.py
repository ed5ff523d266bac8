"""Where the ground has changed and others do not know it yet."""

from collections.abc import Iterable

from tms_soil.grid import TILE, Grid
from tms_soil.surface import Bounds


class Changes:
    """Rectangles that have changed, one for each tile, those first that have waited longest."""

    def __init__(self, grid: Grid) -> None:
        self._x0, self._y0, self._x1, self._y1 = grid.bounds
        self._waiting: dict[tuple[int, int], Bounds] = {}

    def add(self, changed: Iterable[Bounds]) -> None:
        """Note rectangles [m of map]; what of them is beside the site does not count."""
        for x0, y0, x1, y1 in changed:
            a, b, c, d = max(x0, self._x0), max(y0, self._y0), min(x1, self._x1), min(y1, self._y1)
            if a < c and b < d:
                self._add((a, b, c, d))

    def _add(self, changed: Bounds) -> None:
        x0, y0, x1, y1 = changed
        for row in range(int((y0 - self._y0) // TILE), int((y1 - self._y0) // TILE) + 1):
            for column in range(int((x0 - self._x0) // TILE), int((x1 - self._x0) // TILE) + 1):
                left, low = self._x0 + column * TILE, self._y0 + row * TILE
                part = max(x0, left), max(y0, low), min(x1, left + TILE), min(y1, low + TILE)
                if part[0] < part[2] and part[1] < part[3]:
                    old = self._waiting.get((row, column), part)
                    self._waiting[row, column] = (
                        min(old[0], part[0]), min(old[1], part[1]), max(old[2], part[2]), max(old[3], part[3])
                    )  # fmt: skip

    def take(self, count: int) -> list[Bounds]:
        """At most so many rectangles, which are known from now on."""
        return [self._waiting.pop(tile) for tile in list(self._waiting)[:count]]
