"""The scene of a machine: the other machines of the site; one that has told no place is no obstacle."""

import itertools

import numpy as np

from tms_config.clock import monotonic
from tms_control.links import placed
from tms_machine.drift import FRESH
from tms_machine.joint_states import JointStates
from tms_machine.places import PERIOD, Places
from tms_reason.errors import SubtaskFailed
from tms_reason.reason import Reason
from tms_rp.neighbour import Neighbour, Posture
from tms_rp.reasons import PlaceUnknown
from tms_rp.scene import Scene
from tms_runtime.app import App


class Neighbours:
    """The other machines, as seen from this one."""

    def __init__(self, app: App) -> None:
        self._site, self._own, self._log = app.site, app.machine, app.log
        self._others = [name for name in app.site.file.machines if name != app.machine]
        if not self._others:
            return  # no place matters
        borders = {name: app.site.border(name) for name in app.site.file.machines}
        self._places = Places(app.ros, borders)
        models = {name: app.site.model_of(name) for name in self._others}
        self._bodies = {name: Neighbour(name, model) for name, model in models.items()}
        self._driven = {name: model.driven for name, model in models.items()}
        self._joints = {
            name: JointStates(app.ros, name, borders[name], self._driven[name])
            for name, model in models.items()
            if model.shapes and borders[name].joint_states
        }
        app.ros.poll_in_thread(PERIOD, self._take, "neighbours")

    def _take(self) -> None:
        self._places.take()
        for joints in self._joints.values():
            joints.take()

    def unready(self) -> Reason | None:
        """Why it is not known where this machine stands, if its pose should tell it and others may be near."""
        return self._places.missing(self._own, monotonic(), FRESH) if self._others else None

    def scene(self, as_told: bool = False) -> Scene:
        """The other machines in our base_link, as far as both places are known.

        `as_told`: nothing is grown for its age.

        Raises:
            SubtaskFailed: the pose of this machine is missing.
        """
        if not self._others:
            return Scene()
        if missing := self.unready():
            raise SubtaskFailed(missing)
        own = self._places.place(self._own)
        places = {name: place for name in self._others if (place := self._places.place(name)) is not None}
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

    def _posture(self, name: str, now: float, as_told: bool) -> Posture | None:
        last = self._joints[name].last if name in self._joints else None
        if last is None:
            return None
        return Posture(dict(zip(self._driven[name], last[1], strict=True)), 0.0 if as_told else now - last[0])
