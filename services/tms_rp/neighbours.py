"""The scene of a machine: the other machines of the site; one that has told no place is no obstacle."""

import itertools
import threading

import numpy as np

from tms_config.clock import monotonic
from tms_control.links import placed
from tms_machine.drift import FRESH
from tms_machine.listener import Listener
from tms_machine.places import PERIOD
from tms_reason.errors import SubtaskFailed
from tms_reason.reason import Reason
from tms_rp.neighbour import Neighbour, Posture
from tms_rp.reasons import PlaceUnknown
from tms_rp.scene import Scene
from tms_runtime.app import App


class Neighbours:
    """The other machines, as seen from this one."""

    def __init__(self, app: App) -> None:
        self._own, self._log = app.machine, app.log
        self._others = [name for name in app.site.file.machines if name != app.machine]
        if not self._others:
            return  # no place matters
        models = {name: app.site.model_of(name) for name in self._others}
        self._bodies = {name: Neighbour(name, model) for name, model in models.items()}
        jointed = [name for name, model in models.items() if model.shapes]
        self._listener = Listener(app.ros, app.site, app.site.file.machines, jointed)
        self._taking = threading.Lock()  # a listener is for one thread
        app.ros.poll_in_thread(PERIOD, self._take, "neighbours")

    def unready(self) -> Reason | None:
        """Why it is not known where this machine stands, if its pose should tell it and others may be near."""
        return self._listener.places.missing(self._own, monotonic(), FRESH) if self._others else None

    def scene(self, as_told: bool = False) -> Scene:
        """The other machines in our base_link, as far as both places are known.

        `as_told`: nothing is grown for its age.

        Raises:
            SubtaskFailed: the pose of this machine is missing.
        """
        if not self._others:
            return Scene()
        self._take()  # a machine may have moved since the last time, and another have said that it has arrived
        if missing := self.unready():
            raise SubtaskFailed(missing)
        own = self._listener.places.place(self._own)
        places = {name: place for name in self._others if (place := self._listener.places.place(name)) is not None}
        if own is None:
            if places:
                self._log.warning("place_unknown", target=self._own, reason=PlaceUnknown(self._own))
            return Scene()
        back, now = np.linalg.inv(placed(*own[:3])), monotonic()
        found = [
            self._bodies[name].obstacles(
                back @ placed(*place[:3]), 0.0 if as_told else now - place.received, self._posture(name, now, as_told)
            )
            for name, place in places.items()
        ]
        return Scene(tuple(itertools.chain.from_iterable(found)))

    def _take(self) -> None:
        with self._taking:
            self._listener.take()

    def _posture(self, name: str, now: float, as_told: bool) -> Posture | None:
        told = self._listener.joints(name)
        return None if told is None else Posture(told.angles, 0.0 if as_told else now - told.received)
