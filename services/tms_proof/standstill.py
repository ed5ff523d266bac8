"""When a machine counts as standing: every joint and source, after the stop, by position and velocity. Pure logic.

A stop is proven when samples that were received *and* measured after the stop and after the machine's dead time show,
for every channel of every source, that it stood for a while: before that, a command that is still on its way through
the hydraulics may move it. A channel without samples does not count as standing.
"""

from dataclasses import dataclass, replace

from tms_proof.channel import WORST, Limits, Place
from tms_proof.facts import MachineFacts, SourceFacts
from tms_proof.proof import INFINITE, NOTHING, SEEN, Expected, Proof
from tms_proof.reasons import Beyond, Moving, NoSource, NotLongEnough
from tms_proof.source import LABELS, SourceSample, SourceWatch, Trouble
from tms_reason.reason import Reason

JOINTS, ODOM, POSE, IMU = "joint_states", "odom", "pose", "imu"
PLACE, HEADING, TURNING = "place", "heading", "turning"
HARD = 0.2  # rad; a joint that far beyond its limit is impossible: its sensor, or its name, is wrong
SAME_TIME = 1e-6  # s
OBEYS = 3.5  # s that a machine may go on after the command to stop, unless it was seen to obey


@dataclass(frozen=True)
class Travel:
    """How far a machine went."""

    joint: str = ""  # the joint that went furthest, or `heading`
    angle: float = 0.0  # rad
    way: float = 0.0  # m, of the base


class StandStill:
    """The watch over one machine; all times are seconds of one monotonic clock."""

    def __init__(self, facts: MachineFacts) -> None:
        self._facts = facts
        answers, joints = facts.responses, facts.joint_response.values()
        # Seconds for which a command may still be on its way ...
        self.dead_time = max((one.dead_time for one in answers), default=0.0) / facts.speed
        # ... and after them, until every motion has ended: from full speed, and a lag more.
        self.braking = max((one.brakes + one.lag for one in answers), default=0.0) / facts.speed
        # Dead time and lag of the slowest joint [s of the machine]: then it is where its reference was.
        self.reached = max((one.dead_time for one in joints), default=0.0)
        self.reached += max((one.lag for one in joints), default=0.0)
        self.sources: dict[str, SourceWatch] = {
            name: SourceWatch(name, source, _channels(name, facts, source)) for name, source in facts.sources.items()
        }
        self._marks: dict[str, dict[str, Place]] = {}
        self._angles: dict[str, float] = {}
        self._way = 0.0
        self._quiet_since = -INFINITE  # when our last goal ended: its last commands may still be on their way
        self._sent_at = -INFINITE  # when our last goal left for the machine
        self._motion_at = -INFINITE  # when a motion was last seen ...
        self._evident_at = -INFINITE  # ... that no replayed record could hide
        self._doubted_at = -INFINITE  # when a source could not be believed although a stop was to be proven
        self._beyond: Reason | None = None  # the joint that the last message shows beyond its limits

    @property
    def dead_times(self) -> dict[str, float]:
        """Seconds for which a command of each joint may still be on its way."""
        return {name: self._dead_time(name) for name in self._facts.joints}

    def _dead_time(self, joint: str) -> float:
        response = self._facts.joint_response.get(joint)  # a passive joint has none
        return response.dead_time / self._facts.speed if response else 0.0

    @property
    def unstamped(self) -> list[Reason]:
        """Sources whose messages are not stamped: for them only the arrival counts."""
        return [one.label for one in self.sources.values() if one.source.stamps == "none"]

    def published(self, source: str, nodes: tuple[str, ...]) -> None:
        """Note who publishes a source, where there is more than one."""
        self.sources[source].publishers = nodes

    def take(self, name: str, sample: SourceSample) -> None:
        """Take one message of a source."""
        source = self.sources[name]
        source.take(sample)
        if name == JOINTS:
            self._beyond = self._beyond_limits()
        if source.fast:
            self._motion_at = max(self._motion_at, sample.received)
        if source.evident:
            self._evident_at = max(self._evident_at, sample.received)
        for channel, away in source.travel(self._marks.get(name, {})).items():
            if channel == PLACE:
                self._way = max(self._way, away)
            else:
                # A new dict: other threads read the old one without a lock.
                self._angles = {**self._angles, channel: max(self._angles.get(channel, 0.0), away)}

    # what is known

    @property
    def positions(self) -> dict[str, float]:
        """Last position of each joint [rad]."""
        joints = self.sources.get(JOINTS)
        return {name: place[0] for name, place in joints.places().items()} if joints else {}

    def seen(self, now: float) -> dict[str, float]:
        """Positions of the joints [rad] as long as they are news; a machine that is not heard may be anywhere."""
        joints = self.sources.get(JOINTS)
        return self.positions if joints is not None and joints.age(now) <= joints.longest else {}

    @property
    def velocities(self) -> dict[str, float]:
        """Last velocity of each joint, where it is reported [rad/s]."""
        joints = self.sources.get(JOINTS)
        last = {name: one.last for name, one in joints.channels.items()} if joints else {}
        return {name: seen.speed for name, seen in last.items() if seen is not None and seen.speed is not None}

    def age(self, now: float) -> float:
        """Seconds since the last sample of the channel that is silent for longest, infinite before the first."""
        return max((source.age(now) for source in self.sources.values()), default=INFINITE)

    def silent(self, now: float, limit: float) -> Reason | None:
        """The channel of which no sample has come for `limit` seconds."""
        if not self.sources:
            return NoSource()
        return next(filter(None, (source.silent(now, limit) for source in self.sources.values())), None)

    def trouble(self, now: float) -> Trouble | None:
        """Why a source cannot be believed; a trouble that does not pass comes first."""
        found = [one for source in self.sources.values() if (one := source.trouble(now)) is not None]
        if (beyond := self._beyond) is not None:
            found.append(Trouble(beyond))
        return min(found, key=lambda one: one.passes, default=None)

    def _beyond_limits(self) -> Reason | None:
        for name, angle in self.positions.items():
            joint = self._facts.joints[name]
            if joint.low is not None and angle < joint.low - HARD:
                return Beyond(LABELS[JOINTS], name, angle, joint.low)
            if joint.high is not None and angle > joint.high + HARD:
                return Beyond(LABELS[JOINTS], name, angle, joint.high)
        return None

    # motion

    @property
    def moved_at(self) -> float:
        """When a motion was last seen [s]; minus infinity if never."""
        return self._motion_at

    def moving(self) -> bool:
        """Whether any of the last messages showed a motion, or a channel has no samples."""
        return not self.sources or any(source.moving() for source in self.sources.values())

    def standing(self, now: float, passing: bool = False) -> bool:
        """Whether it was seen to stand for long enough, with or without a stop; `passing`: also by a new clock."""
        trouble = self.trouble(now)
        return (trouble is None or (passing and trouble.passes)) and self._stands(-INFINITE, now)

    def _stands(self, start: float, now: float) -> bool:
        seconds = self._facts.still.seconds
        return bool(self.sources) and all(one.proves(start, now, seconds) for one in self.sources.values())

    def settle(self, now: float) -> None:
        """Accept new clocks once the machine has stood long enough by their stamps."""
        if any(source.new_clock for source in self.sources.values()):
            stands = self._stands(-INFINITE, now)
            for source in self.sources.values():
                source.settle(now, stands)

    def accept_clocks(self) -> None:
        """Accept new clocks, as a person has looked at the machine."""
        for source in self.sources.values():
            source.accept_clock()

    # proof

    def leaves(self, now: float) -> dict[str, float]:
        """Note that a goal of ours leaves for the machine now; returns where its joints are [rad]."""
        self._sent_at = self._quiet_since = now
        return self.positions

    def commanded(self, now: float) -> None:
        """Note that a goal of ours moves the machine now."""
        self._quiet_since = now

    def proof(self, begun: float, strongest: bool, expected: Expected = NOTHING) -> Proof:
        """What must be seen after a stop that was commanded at `begun`.

        A strongest stop that acts at once (`emg_stop_at_once`) needs no dead time if its effect can be seen: the
        machine clearly moves, or no command is on its way. Else a machine that ignores it would be believed to stand.
        If an expected motion was never seen, or a source could not be believed for a while, the sources are doubtful
        (they may replay a record): then no sample counts before every motion must have ended, also that of a machine
        which goes on for a while.
        """
        if self.trouble(begun) is not None:
            self._doubted_at = begun
        since = max(begun - WORST, self._sent_at + self.dead_time)  # before, it was the motion of the goal before
        visible = self._evident_at > since or begun - self._quiet_since > self.dead_time
        immediate = strongest and self._facts.stops_at_once and visible
        wait, coming = (0.0, {}) if immediate else (self.dead_time, expected.to_come)
        expected = replace(expected, to_come={name: way for name, way in coming.items() if way > SEEN})
        unseen = begun + self.settles
        return Proof(begun + wait, unseen, expected, self._facts.still.seconds, immediate)

    def proven(self, proof: Proof, now: float) -> bool:
        """Whether all that the proof asks for was seen."""
        if self.trouble(now) is not None:
            self._doubted_at = now
            return False
        return self._stands(max(self._start(proof), self._surprised() + self.settles), now)

    @property
    def settles(self) -> float:
        """Seconds after a stop in which every motion has ended, also that of a machine which goes on for a while."""
        return self.dead_time + self.braking + OBEYS

    def _start(self, proof: Proof) -> float:
        seen = self._doubted_at < proof.unseen - self.settles - SAME_TIME
        places = self.positions if proof.expected.behind else {}  # worked out only where they count
        seen = seen and proof.expected.seen(self._motion_at, self._angles, places)
        return proof.start if seen else proof.unseen

    def _surprised(self) -> float:
        return max((source.surprised for source in self.sources.values()), default=-INFINITE)

    def obstacle(self, now: float) -> Reason:
        """Why a stop is not proven."""
        trouble = self.trouble(now)
        if trouble is not None:
            return trouble.reason
        for source in self.sources.values():
            if silent := source.silent(now, source.longest):
                return silent
        return Moving() if self.moving() else NotLongEnough()

    # travel

    def mark(self) -> None:
        """Begin to count travel anew."""
        self._marks = {name: source.places() for name, source in self.sources.items()}
        self._angles, self._way = {}, 0.0

    def travel(self) -> Travel:
        """How far each part has been from the mark at most."""
        angles = self._angles
        joint = max(angles, key=lambda name: angles[name], default="")
        return Travel(joint, angles.get(joint, 0.0), self._way)


def _channels(name: str, facts: MachineFacts, source: SourceFacts) -> dict[str, Limits]:
    """The channels of a source, and when each counts as standing."""
    still, speed, resolution, longest = facts.still, facts.speed, source.resolution, source.longest
    if name == JOINTS:
        return {
            joint: Limits(
                still.velocity, limits.velocity, resolution, limits.low is None and limits.high is None, speed, longest
            )
            for joint, limits in facts.joints.items()
        }
    if name == IMU:
        return {TURNING: Limits(still.angular)}  # it tells no positions: top speed and scale do not count
    return {
        PLACE: Limits(still.linear, facts.drive_velocity, resolution, False, speed, longest),
        HEADING: Limits(still.angular, facts.turn_velocity, resolution, True, speed, longest),
    }
