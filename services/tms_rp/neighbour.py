"""What another machine takes up: its footprint where it was last told to be, its arm or vessel as it was last told.

What was told too long ago is grown by as far as it may have moved since. A machine that is not heard any more loses its
permits and stops, so that this has an end.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from tms_config.models import DRIVE, Box, MachineModel
from tms_control.links import Links, Matrix, reach, reaches
from tms_decision.permit_link import LEASE
from tms_rp.reasons import PartOf
from tms_rp.scene import Obstacle

FRESH = 1.0  # s, what was told longer ago may be wrong


@dataclass(frozen=True)
class Posture:
    """Joint angles [rad] by name, and how long ago they were told [s]."""

    angles: Mapping[str, float]
    age: float


class Neighbour:
    """The body of one other machine."""

    def __init__(self, name: str, model: MachineModel) -> None:
        self._name, self._model = name, model
        self._links = Links(model)
        self._reaches = reaches(model)
        far = reach(model)
        self._anywhere = Box(min=(-far, -far, -far), max=(far, far, far))

    def obstacles(self, place: Matrix, age: float, posture: Posture | None = None) -> list[Obstacle]:
        """Its parts; `place` is that of its base_link in ours, told `age` [s] ago. Without a posture, its footprint."""
        drift = self._drift(age)
        found = [
            Obstacle(PartOf(part, self._name), box, place, age).grown(drift)
            for part, box in self._model.footprint.items()
        ]
        if posture is None:
            return found
        pose = np.array([[posture.angles.get(joint, 0.0) for joint in self._model.joints]])
        places = self._links.places(pose)
        for link in sorted(self._links.moved & self._model.shapes.keys()):
            name, turned = PartOf(link, self._name), self._turned(link, posture.age)
            one = Obstacle(name, self._model.shapes[link], place @ places[link][0], posture.age).grown(turned)
            if turned > self._anywhere.max[0]:
                one = Obstacle(name, self._anywhere, place, posture.age)
            found.append(one.grown(drift))
        return found

    def _drift(self, age: float) -> float:
        """How far [m] a point of the machine may have come by driving and turning since it told its place."""
        drive = self._model.drive
        if drive is None:
            return 0.0
        sizes = [np.hypot(*np.abs([box.min, box.max]).max(axis=0)[:2]) for box in self._model.footprint.values()]
        speed = drive.velocity + drive.turn_velocity * max(sizes, default=0.0)
        braking = max(drive.velocity / drive.acceleration, drive.turn_velocity / drive.turn_acceleration)
        return float(speed * self._seconds(DRIVE, age, braking))

    def _turned(self, link: str, age: float) -> float:
        """How far [m] a point of a link may have come by its joints since they were told."""
        way = 0.0
        for name in self._links.carriers(link):
            joint = self._model.joints[name]
            way += joint.velocity * self._seconds(name, age, joint.velocity / joint.acceleration) * self._reaches[name]
        return way

    def _seconds(self, mover: str, age: float, braking: float) -> float:
        """For how long it may have moved at full speed: unheard, until its permit was lost and it had stopped."""
        answer = self._model.response.get(mover)
        if answer is None:  # a passive joint
            return 0.0
        return max(0.0, min(age - FRESH, LEASE + answer.dead_time + answer.lag + braking / 2))
