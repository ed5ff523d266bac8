"""Asks `tms:ground` for the ground around a machine, for each plan anew."""

from tms_msg_ground.srv import GetHeights

from tms_machine.asking import ask
from tms_machine.places import PERIOD, Places
from tms_reason.errors import RosError
from tms_rp.reasons import GroundUnread
from tms_rp.terrain import REACH, Terrain
from tms_runtime.app import App
from tms_soil.patches import heights
from tms_soil.surface import Heights

SERVICE = "/tms/ground/get_heights"
LIMIT = 0.8  # s for tms:ground to answer
AROUND = 1.5 * REACH  # m, so that the corners of what is looked at are in it


class ToldGround:
    """What is known of the ground; while tms:ground is away, what it told last there. Only where a site has one."""

    def __init__(self, app: App) -> None:
        self._app, self._machine = app, app.machine
        self._there = app.site.file.ground is not None
        self._last: Heights | None = None
        if self._there:
            self._tracks = app.site.model_of(app.machine).tracks
            self._places = Places(app.ros, {app.machine: app.site.border(app.machine)})
            app.ros.prepare(GetHeights, SERVICE)
            app.ros.poll_in_thread(PERIOD, lambda: self._places.take(), "own_place")

    def around(self) -> Terrain | None:
        """The ground as it is now; None where nobody knows it, or where the machine stands."""
        place = self._places.place(self._machine) if self._there else None
        if place is None:
            return None
        if self._app.ros.has_service(GetHeights, SERVICE):
            self._read(place.x, place.y)
        return None if self._last is None else Terrain(self._last, self._tracks, (place.x, place.y, place.yaw))

    def _read(self, x: float, y: float) -> None:
        request = GetHeights.Request(x0=x - AROUND, y0=y - AROUND, x1=x + AROUND, y1=y + AROUND)
        try:
            self._last = heights(ask(self._app.ros, GetHeights, SERVICE, request, LIMIT).ground)
        except RosError as error:
            self._app.log.warning("ground_unread", reason=GroundUnread(error.reason))
