"""What another machine takes up: its footprint where it was last told to be, its arm or vessel as it was last told.

What was told too long ago is grown by as far as it may have moved since.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from tms_config.models import Box, MachineModel
from tms_control.links import Links, Matrix, reach, reaches
from tms_machine.drift import drift, moving
from tms_rp.reasons import PartOf
from tms_rp.scene import Obstacle


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
        far = drift(self._model, age)
        found = [
            Obstacle(PartOf(part, self._name), box, place, age).grown(far)
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
            found.append(one.grown(far))
        return found

    def _turned(self, link: str, age: float) -> float:
        """How far [m] a point of a link may have come by its joints since they were told."""
        way = 0.0
        for name in self._links.carriers(link):
            joint = self._model.joints[name]
            way += (
                joint.velocity
                * moving(self._model, name, age, joint.velocity / joint.acceleration)
                * self._reaches[name]
            )
        return way
