"""Where the other machines of the site stand, from /tf; a machine without a place in /tf is no obstacle."""

import numpy as np
from tf2_msgs.msg import TFMessage

from tms_machine.frames import Frames
from tms_rp.clearance import Matrix, Obstacle, placed
from tms_rp.reasons import PartOf, PlaceUnknown
from tms_runtime.app import App

FRAMES_PERIOD = 0.2  # s; a plan does not look itself, which would cost it some ms: 0.1 to 0.25 for each message
DEPTH = 200  # messages per sample: as many as ten machines with joints and navigation publish meanwhile
FIXED = 100  # messages that are published once, by as many processes


class Neighbours:
    """Keeps the last place of every machine: a machine without new messages still stands there."""

    def __init__(self, app: App) -> None:
        self._site, self._own, self._log = app.site, app.machine, app.log
        self._bases = {name: app.site.border(name).base_frame for name in app.site.file.machines}
        self._frames = Frames(self._bases.values())
        if len(self._bases) == 1:
            return  # the site has no other machine
        self._samples = app.ros.sample(TFMessage, "/tf", DEPTH)
        app.ros.subscribe(TFMessage, "/tf_static", self._frames.receive_fixed, depth=FIXED, latched=True)
        app.ros.poll_in_thread(FRAMES_PERIOD, self._take_frames, "neighbours")

    def _take_frames(self) -> None:
        for message in self._samples():
            self._frames.receive(message)

    def _place(self, name: str) -> Matrix | None:
        found = self._frames.place(self._bases[name])
        return None if found is None else placed(found.x, found.y, found.yaw)

    def obstacles(self) -> list[Obstacle]:
        """Footprints of the other machines in our base_link, as far as both places are known."""
        own = self._place(self._own)
        places = {name: self._place(name) for name in self._bases if name != self._own}
        others = {name: place for name, place in places.items() if place is not None}
        if own is None:
            if others:
                self._log.warning("place_unknown", target=self._own, reason=PlaceUnknown(self._own))
            return []
        back = np.linalg.inv(own)
        return [
            Obstacle(PartOf(part, name), box, back @ place)
            for name, place in others.items()
            for part, box in self._site.model_of(name).footprint.items()
        ]
