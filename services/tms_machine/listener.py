"""Where several machines stand and how their joints are, as they were told last."""

from collections.abc import Iterable
from typing import NamedTuple

from tms_config.config import Site
from tms_machine.joint_states import JointStates
from tms_machine.places import Places
from tms_ros.node import Ros


class JointsTold(NamedTuple):
    """Angles of the joints that commands move [rad], and when they came [s, monotonic]."""

    angles: dict[str, float]
    received: float


class Listener:
    """Hears machines; `take` is for one thread, the answers are for any."""

    def __init__(self, ros: Ros, site: Site, machines: Iterable[str], jointed: Iterable[str], depth: int = 1) -> None:
        """`machines`: whose places matter; `jointed`: whose joints do, too; `depth`: as of JointStates."""
        borders = {name: site.border(name) for name in machines}
        self.places = Places(ros, borders)
        self._driven = {name: site.model_of(name).driven for name in jointed if borders[name].joint_states}
        self._joints = {
            name: JointStates(ros, name, borders[name], driven, depth) for name, driven in self._driven.items()
        }

    def take(self) -> None:
        """Take what has come."""
        self.places.take()
        for joints in self._joints.values():
            joints.take()

    def has_joints(self, machine: str) -> bool:
        """Whether the joints of a machine are listened to."""
        return machine in self._joints

    def joints(self, machine: str) -> JointsTold | None:
        """The joints of a machine; None as long as it has told none, or none are listened to."""
        last = self._joints[machine].last if machine in self._joints else None
        return None if last is None else JointsTold(dict(zip(self._driven[machine], last[1], strict=True)), last[0])

    def new_joints(self, machine: str) -> list[dict[str, float]]:
        """The angles [rad] that the last `take` has found, oldest first."""
        if machine not in self._joints:
            return []
        return [dict(zip(self._driven[machine], one, strict=True)) for one in self._joints[machine].new]
