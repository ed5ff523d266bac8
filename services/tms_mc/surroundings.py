"""What is around a machine that drives: other machines of the site, and blocked areas and roads of the database."""

from collections.abc import Mapping

from tms_config.clock import monotonic
from tms_control.from_above import from_above
from tms_control.ground import Body, Ground
from tms_control.path import Pose
from tms_control.reasons import MachineThere
from tms_control.roads import Roads
from tms_machine.drift import drift
from tms_machine.places import PERIOD, Places
from tms_machine.values import Value
from tms_mc.area_walls import AreaWalls
from tms_mc.blocked_areas import RECORD as AREAS
from tms_mc.blocked_areas import areas
from tms_mc.reasons import AreasUnread
from tms_mc.records import Records
from tms_mc.road_records import RECORD as ROADS
from tms_mc.road_records import roads
from tms_reason.errors import RosError
from tms_runtime.app import App


class Surroundings:
    """A machine that has told no place, or has no footprint, is left out."""

    def __init__(self, app: App) -> None:
        self._app = app
        models = {name: app.site.model_of(name) for name in app.site.file.machines if name != app.machine}
        self._models = {name: model for name, model in models.items() if model.footprint}
        self._places = Places(app.ros, {name: app.site.border(name) for name in self._models})
        self._shapes = {name: from_above(model) for name, model in self._models.items()}
        self._areas: list[Body] = []
        self._walls, self._walled = AreaWalls(app), list[Body]()
        self._records, self.roads = Records(app), Roads()
        if self._models:
            app.ros.poll_in_thread(PERIOD, self._places.take, "places")

    def read(self, here: Pose) -> None:
        """Read areas, blocked ones and roads anew, for a way that begins here; what cannot be read holds as before.

        Raises:
            SubtaskFailed: BadRecord; or a record is older than it may be.
        """
        try:
            self._walled = self._walls.read(here)
        except RosError as error:
            self._app.log.warning("areas_unread", reason=error.reason)
        if not self._records.there():
            return
        try:
            self._areas = areas(self._records.read(AREAS) or {})
            self.roads = roads(self._records.read(ROADS) or {}, self._section)
        except RosError as error:
            self._app.log.warning("areas_unread", reason=AreasUnread(error.reason))

    def _section(self, name: str) -> Mapping[str, Value] | None:
        """A section of a road: of this machine, else of all."""
        own = self._records.read(name, self._app.machine)
        return self._records.read(name) if own is None else own

    def ground(self) -> Ground:
        """All of it now: machines where they were told to be last, and how far they may have moved since."""
        now = monotonic()
        found = [
            Body.of(MachineThere(name), part, Pose(*place[:3]), drift(model, now - place.received))
            for name, model in self._models.items()
            if (place := self._places.place(name)) is not None
            for part in self._shapes[name].values()
        ]
        return Ground((*found, *self._areas, *self._walled))
