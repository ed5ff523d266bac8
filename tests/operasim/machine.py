"""A machine of a scene: joints, tracks, base and emergency stop. Pure: it knows no messages and no clock."""

import math
from collections.abc import Mapping, Sequence

from operasim.base import Base
from operasim.drive import Drive
from operasim.front import Front
from operasim.model import MachineFile, Placed, Unknowns
from operasim.tracks import Tracks

SWING = "swing_joint"


class Machine:
    """Scripts run before the engine's step, as in the original: they see what the last step has left."""

    def __init__(self, file: MachineFile, placed: Placed, unknowns: Unknowns) -> None:
        self._unknowns = unknowns
        self.joints: dict[str, Drive | None] = {
            name: Drive(joint.drive(unknowns), math.radians(joint.target)) if joint is not None else None
            for name, joint in file.joints.items()
        }
        self.tracks = Tracks(file.tracks.model(file.mass))
        self.base = Base(*placed.place, math.radians(placed.yaw))
        delays = {name: joint.dead_time if joint is not None else None for name, joint in file.joints.items()}
        self.front = Front(
            {name: None if one is None else one + unknowns.dead_time for name, one in delays.items()}, self._aim
        )
        self.turning = 0.0  # rad/s of the base in the last step, by its tracks and by the kick of its swing
        self.stopped = False
        self._held = False  # the drives aim at where the joints were in the first step of the stop

    # commands, by frames of the simulator

    def joint_cmd(self, names: Sequence[str], values: Sequence[float], now: float) -> None:
        """Take a command for several joints [rad].

        Raises:
            IndexError: it has less values than names.
        """
        if not self.stopped:
            self.front.command(names, values, now)

    def angle(self, name: str, value: float) -> None:
        """Aim a joint at an angle [rad] at once."""
        if not self.stopped:
            self._aim(name, value)

    def drive_params(self, name: str, stiffness: float, damping: float) -> None:
        """Change the drive of a joint."""
        if (joint := self.joints[name]) is not None:
            joint.stiffness, joint.damping = stiffness, damping

    def track_cmd(self, velocities: Mapping[str, float]) -> None:
        """Take speeds of tracks [m/s], not limited; or forward and turn together, limited as a Twist."""
        self.tracks.left.command = velocities.get("left_track", self.tracks.left.command)
        self.tracks.right.command = velocities.get("right_track", self.tracks.right.command)
        if "forward_volume" in velocities and "turn_volume" in velocities:
            self.tracks.twist(velocities["forward_volume"], velocities["turn_volume"])

    def emg_stop(self, stopped: bool) -> None:
        """Stop, or release. Commands that wait stay; those whose dead time ends meanwhile play at the release."""
        self.stopped = stopped
        self._held = self._held and stopped

    # steps of 20 ms

    def scripts(self, now: float) -> None:
        """What the scripts do in a step."""
        if self.stopped:
            self._hold()
        else:
            self.front.step(now)

    def physics(self, seconds: float) -> None:
        """What the engine does in a step."""
        swing, yaw = self.joints.get(SWING), self.base.yaw
        before = swing.velocity if swing is not None else 0.0
        for joint in self.joints.values():
            if joint is not None:
                joint.step(seconds)
        self.tracks.step(seconds)
        self.base.drive(self.tracks.forward, self.tracks.turn * self._unknowns.yaw_gain, seconds)
        if swing is not None:
            self.base.react(before, swing.velocity, self._unknowns.kick)
        self.turning = (self.base.yaw - yaw) / seconds

    def _hold(self) -> None:
        self.tracks.stop()
        if self._held:
            return
        self._held = True
        for joint in self.joints.values():
            if joint is not None:
                joint.target = joint.position

    def _aim(self, name: str, value: float) -> None:
        if (joint := self.joints.get(name)) is not None:
            joint.target = value
