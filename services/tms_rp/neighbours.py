"""Where the other machines of the site stand; a machine that has told no place is no obstacle."""

import numpy as np

from tms_config.clock import monotonic
from tms_machine.places import PERIOD, Places
from tms_reason.errors import SubtaskFailed
from tms_reason.reason import Reason
from tms_rp.links import Matrix, placed
from tms_rp.reasons import PartOf, PlaceUnknown
from tms_rp.scene import Obstacle, Scene
from tms_runtime.app import App

FRESH = 1.0  # s, an older pose may be that of a machine that has driven on


class Neighbours:
    """The other machines, as seen from this one."""

    def __init__(self, app: App) -> None:
        self._site, self._own, self._log = app.site, app.machine, app.log
        self._others = [name for name in app.site.file.machines if name != app.machine]
        if not self._others:
            return  # no place matters
        self._places = Places(app.ros, {name: app.site.border(name) for name in app.site.file.machines})
        app.ros.poll_in_thread(PERIOD, self._places.take, "neighbours")

    def unready(self) -> Reason | None:
        """Why it is not known where this machine stands, if its pose should tell it and others may be near."""
        return self._places.missing(self._own, monotonic(), FRESH) if self._others else None

    def _place(self, name: str) -> Matrix | None:
        found = self._places.place(name)
        return None if found is None else placed(found.x, found.y, found.yaw)

    def scene(self) -> Scene:
        """Footprints of the other machines in our base_link, as far as both places are known.

        Raises:
            SubtaskFailed: the pose of this machine is missing.
        """
        if not self._others:
            return Scene()
        if missing := self.unready():
            raise SubtaskFailed(missing)
        own = self._place(self._own)
        places = {name: self._place(name) for name in self._others}
        others = {name: place for name, place in places.items() if place is not None}
        if own is None:
            if others:
                self._log.warning("place_unknown", target=self._own, reason=PlaceUnknown(self._own))
            return Scene()
        back = np.linalg.inv(own)
        return Scene(
            tuple(
                Obstacle(PartOf(part, name), box, back @ place)
                for name, place in others.items()
                for part, box in self._site.model_of(name).footprint.items()
            )
        )
