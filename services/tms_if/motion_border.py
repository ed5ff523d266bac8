"""Motions under the names that primitives of version 6 call (`tms_rp_...`), where the site file says so.

There another program of that system serves them (irvs/tms_if_for_opera), and two servers of one name would both move
the machine: so it is off by default. Each goal goes to the gateway with its UUID. The planner of an excavator has such
names, too (tms_rp/excavator.py).

This process stands behind the goals that it passes on: when it is lost, the gateway cancels them
(tms_rc/relayed_goals.py).
"""

import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from tms_msg_rp.action import TmsRpCrawlerDumpDumpAngle, TmsRpCrawlerDumpSwingAngle, TmsRpFollowStraight

from tms_if.relay import Relay
from tms_machine.border import RELAYING, motions
from tms_machine.permit import Permit
from tms_ros.client import AnyPeer
from tms_ros.goals import Ended, Outcome
from tms_ros.server import AnyGoal
from tms_runtime.app import App


class Renamed(Relay):
    """Goals between two types whose fields are called the same."""

    def __init__(self, machine: str, served: Any, peer: AnyPeer, sent: Any) -> None:
        """`sent`: type of the action behind."""
        super().__init__(machine, served, peer)
        self._sent = sent

    def request(self, request: Any) -> Any:
        return copied(request, self._sent.Goal())

    def feedback(self, feedback: Any) -> Any:
        return copied(feedback, self._served.Feedback())

    def result(self, outcome: Outcome, result: Any) -> Any:
        return copied(result, self._served.Result())


class Straight(Renamed):
    """Goals of TmsRpFollowStraight: the navigation drives to the pose, as in the C++ system."""

    def feedback(self, feedback: Any) -> TmsRpFollowStraight.Feedback:
        return TmsRpFollowStraight.Feedback(running=True)

    def result(self, outcome: Outcome, result: Any) -> TmsRpFollowStraight.Result:
        return TmsRpFollowStraight.Result(result=outcome is Outcome.SUCCEEDED)


def copied(source: Any, target: Any) -> Any:
    """The target with the fields of the source that it has, too; None has none."""
    for field in target.get_fields_and_field_types():
        if hasattr(source, field):
            setattr(target, field, getattr(source, field))
    return target


class Standing:
    """Stands behind the oldest goal that has not ended: the one that the gateway lets move the machine."""

    def __init__(self, permit: Permit) -> None:
        self._permit = permit
        self._open: list[bytes] = []
        self._changing = threading.Lock()

    def behind(self, run: Callable[[AnyGoal], Ended[Any]]) -> Callable[[AnyGoal], Ended[Any]]:
        """The same, with this process behind the goal meanwhile."""

        def stood(goal: AnyGoal) -> Ended[Any]:
            self._change(self._open.append, goal.uuid)
            try:
                return run(goal)
            finally:
                self._change(self._open.remove, goal.uuid)

        return stood

    def _change(self, change: Callable[[bytes], None], goal: bytes) -> None:
        with self._changing:
            before = self._open[:1]
            change(goal)
            if not self._open:
                self._permit.drop()
            elif self._open[:1] != before:
                self._permit.hold(self._open[0])


@dataclass(frozen=True)
class Name:
    """A name that primitives call, and its type where it is not that of the machine's own action."""

    motion: str  # key under borders:
    served: str
    kind: Any = None
    relay: type[Renamed] = Renamed


NAMES = (
    Name("navigate_to_pose", "tms_rp_navigate_anywhere"),
    Name("navigate_to_pose", "tms_rp_navigate_follow_straight", TmsRpFollowStraight, Straight),
    Name("navigate_through_poses", "tms_rp_navigate_through_poses"),
    Name("follow_waypoints", "tms_rp_navigate_follow_waypoints"),
    Name("set_bulldozer_blade", "tms_rp_set_bulldozer_blade"),
    Name("set_dump_angle", "tms_rp_set_dump_angle", TmsRpCrawlerDumpDumpAngle),
    Name("set_swing_angle", "tms_rp_set_swing_angle", TmsRpCrawlerDumpSwingAngle),
    Name("set_swing_angle", "tms_rp_set_swing_angle_align_to_heading", TmsRpCrawlerDumpSwingAngle),
)


def serve(app: App) -> None:
    """Serve the motions that the machine has."""
    standing = Standing(Permit(app.ros, app.pulse, app.machine, RELAYING))
    there = {motion.field: motion for motion in motions(app.site.border(app.machine))}
    for name in NAMES:
        if (motion := there.get(name.motion)) is not None:
            peer = app.ros.peer(motion.type, f"/{app.machine}/rc/{motion.served}")
            served = name.kind or motion.type
            relay = name.relay(app.machine, served, peer, motion.type)
            app.ros.serve(served, f"/{app.machine}/{name.served}", standing.behind(relay.run), relay.accept)
