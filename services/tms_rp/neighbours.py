"""Where the other machines of the site stand, as /tf tells; one that was never seen is no obstacle."""

import math

import numpy as np
from tf2_msgs.msg import TFMessage

from tms_core.app import App
from tms_rp.clearance import Matrix, Obstacle, placed

MAP = "map"
LOOK = 1.0  # s
DEPTH = 20  # transforms a look: every machine sends many between two looks


class Neighbours:
    """Keeps the last place of every machine: one that has fallen silent still stands somewhere."""

    def __init__(self, app: App) -> None:
        self._site, self._own = app.site, app.machine
        self._frames = {app.site.border(name).base_frame: name for name in app.site.file.machines}
        self._places: dict[str, Matrix] = {}
        self._news = app.ros.sample(TFMessage, "/tf", DEPTH)
        app.ros.beside(LOOK, self._look, "neighbours")

    def _look(self) -> None:
        for one in (one for message in self._news() for one in message.transforms):
            name = self._frames.get(one.child_frame_id)
            if name is not None and one.header.frame_id == MAP:
                at, q = one.transform.translation, one.transform.rotation
                if not all(map(math.isfinite, (at.x, at.y, q.x, q.y, q.z, q.w))):
                    continue  # a localisation without a fix; nothing would collide with such a place
                yaw = math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))
                self._places[name] = placed(at.x, at.y, yaw)

    def obstacles(self) -> list[Obstacle]:
        """Footprints of the others in our base_link, as far as both places are known."""
        self._look()
        own = self._places.get(self._own)
        if own is None:
            return []
        back = np.linalg.inv(own)
        return [
            Obstacle(f"{part} of {name}", box, back @ place)
            for name, place in list(self._places.items())
            if name != self._own
            for part, box in self._site.model_of(name).footprint.items()
        ]
