"""Heights of the ground for other processes: service /tms/ground/get_heights."""

import threading

import numpy as np
from tms_msg_ground.srv import GetHeights

from tms_ground.reasons import BadCell, NotAnArea
from tms_ground.telling import Teller
from tms_ground.watching import GroundWatch
from tms_reason.errors import TmsError
from tms_reason.wire import to_line
from tms_runtime.app import App
from tms_soil import patches
from tms_soil.grid import COARSE, FINE, SIDE
from tms_soil.surface import Bounds, Heights, Surface
from tms_soil.surface import grid as unknown

SERVICE = "/tms/ground/get_heights"
MOST = 1_500_000  # cells of an answer, 6 MB: 240 m x 240 m of 0.2 m
LARGEST = 10.0  # m, of a cell


class HeightsServer:
    """Answers with heights of now, and with those of the design."""

    def __init__(
        self, app: App, watch: GroundWatch, teller: Teller, lock: threading.Lock, design: Surface | None
    ) -> None:
        """`lock`: while it is held, the ground does not change."""
        self._ros, self._watch, self._teller, self._lock, self._design = app.ros, watch, teller, lock, design
        app.ros.offer_slow(GetHeights, SERVICE, self.answer)

    def answer(self, request: GetHeights.Request, response: GetHeights.Response) -> GetHeights.Response:
        """Heights of a rectangle."""
        try:
            self._fill(request, response)
        except TmsError as error:
            response.error_code, response.error_msg = error.code, to_line(error.reason)
        return response

    def _fill(self, request: GetHeights.Request, response: GetHeights.Response) -> None:
        bounds = _clipped((request.x0, request.y0, request.x1, request.y1), self._watch.area)
        cell = request.cell or COARSE
        size = (bounds[2] - bounds[0]) * (bounds[3] - bounds[1])
        if not (cell >= FINE - 1e-6 and cell <= LARGEST and size / cell**2 <= MOST):
            raise TmsError(BadCell(cell, max(FINE, (size / MOST) ** 0.5), LARGEST))
        with self._lock:
            ground = self._ground(bounds, cell)
            response.ground = patches.patch(ground, self._teller.serial)
            response.ages = patches.numbers(self._watch.ages(ground))
        response.ground.header.stamp = self._ros.now()
        if self._design is not None:
            response.design = patches.numbers(self._design.at(*ground.centres))

    def _ground(self, bounds: Bounds, cell: float) -> Heights:
        grid, side = self._watch.earth.grid, 1 if cell < COARSE - 1e-6 else SIDE
        x0, y0, x1, y1 = bounds
        if abs(cell - side * FINE) < 1e-6:
            return grid.heights(bounds, side)
        wanted = unknown(bounds, cell)
        around = grid.heights((x0 - COARSE, y0 - COARSE, x1 + cell, y1 + cell), side)
        return Heights(wanted.x0, wanted.y0, cell, around.on(wanted))


def _clipped(wanted: Bounds, site: Bounds) -> Bounds:
    """What of a rectangle lies on the site, all of it if it has no size.

    Raises:
        TmsError: NotAnArea.
    """
    x0, y0, x1, y1 = wanted
    if wanted[:2] == wanted[2:]:
        return site
    found = max(x0, site[0]), max(y0, site[1]), min(x1, site[2]), min(y1, site[3])
    if not np.isfinite(wanted).all() or found[0] >= found[2] or found[1] >= found[3]:
        raise TmsError(NotAnArea(x0, y0, x1, y1))
    return found
