"""Faults of a stand-in as real processes: each is switched on, a goal goes through the gateway, and the gateway's
reaction is seen: what the goal ends with, the receipt of the stop, and whether the machine is latched."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from com3_msgs.action import SetDumpAngle
from nav2_msgs.action import FollowWaypoints, NavigateToPose
from tms_msg_rc.msg import MachineState, StopReceipt
from tms_msg_rc.srv import Rearm

from stand_in_rig import SITE, Rig, client_in, pose
from tms_decision.reasons import NotSeen, NotStill
from tms_proof.reasons import Moving
from tms_rc.reasons import AtPose, NoNumber
from tms_reason import wire
from tms_reason.wire import to_line
from tms_ros.client import Call
from tms_ros.goals import Outcome
from tms_ros.node import Ros

pytestmark = [
    pytest.mark.ros,
    pytest.mark.timeout(240),
    pytest.mark.filterwarnings("ignore:module 'sre_:DeprecationWarning"),  # a parser that the ROS wheels bring
]
NAME = "mst110cr_5"  # a name of its own: other tests may have machines in the same domain


class Guarded(Rig):
    """A carrier behind its gateway."""

    def __init__(self, ros: Ros, folder: Path, site: str) -> None:
        self.reported: list[Any] = []
        self.receipts: list[Any] = []
        ros.subscribe(MachineState, f"/{NAME}/rc/state", self.reported.append, latched=True)
        ros.subscribe(StopReceipt, f"/{NAME}/rc/receipts", self.receipts.append, depth=20)
        super().__init__(ros, folder, NAME, site, ("sim:{}", "{}:rc"))
        self.until(lambda: self.reported and self.reported[-1].ready, "a gateway that is ready")

    def go(self, action: Any = NavigateToPose, field: str = "navigate_to_pose", **goal: Any) -> Call:
        """A goal through the gateway: far ahead, unless told otherwise."""
        peer = self.ros.peer(action, f"/{NAME}/rc/{field}")
        self.until(peer.ready, f"gateway for {field}")
        x, y = self.place()
        goal = goal or {"pose": pose(x, y + 200, 1.5708)}
        return peer.send(action.Goal(**goal), on_feedback=self.said.append)

    def driving(self) -> Call:
        call = self.go()
        self.until(lambda: call.outcome is not None or self.odom[-1].twist.twist.linear.x > 0.5, "motion")
        assert call.outcome is None, call.result
        return call

    def stop(self, call: Call) -> Any:
        """Cancel through the gateway; gives the receipt."""
        before = len(self.receipts)
        self.ros.peer(NavigateToPose, f"/{NAME}/rc/navigate_to_pose").cancel(call)
        self.until(lambda: len(self.receipts) > before, "a receipt")
        return self.receipts[-1]

    def latched(self) -> str:
        return str(self.reported[-1].latch) if self.reported else ""

    def order(self) -> None:
        """Put the machine in order and re-arm it, as a person does in two steps."""
        self.until(self._armed, "an armed machine")
        self.be_in_order()

    def _armed(self) -> bool:
        self.be()
        first = self.ros.call(Rearm, f"/{NAME}/rearm", Rearm.Request(), 20.0)
        if first.error_code == "NOT_STOPPED":
            self.until(lambda: self.reported[-1].armed, "news that it is armed")
            return True
        return bool(first.token) and self.ros.call(
            Rearm, f"/{NAME}/rearm", Rearm.Request(token=first.token), 20.0
        ).armed  # fmt: skip


@pytest.fixture(scope="module")
def carrier(tmp_path_factory: pytest.TempPathFactory, domain: int, first_port: int) -> Iterator[Guarded]:
    folder = tmp_path_factory.mktemp("faults")
    with client_in(folder, domain, first_port) as ros:
        rig = Guarded(ros, folder, SITE.format(domain=domain, port=first_port + 64, names="sim", machine=NAME,
                                               model="mst110cr"))  # fmt: skip
        yield rig
        rig.close()


@pytest.fixture
def machine(carrier: Guarded) -> Guarded:
    carrier.order()
    carrier.said.clear()
    return carrier


def test_stall_the_goal_fails_and_the_machine_may_go_on(machine: Guarded) -> None:
    call = machine.driving()
    machine.be(stall=0.1)
    assert machine.end(call) is Outcome.ABORTED
    assert "no progress" in getattr(call.result, "error_msg", "no progress")
    assert not machine.latched()


def test_goals_outside_the_limits_do_not_leave_the_gateway(machine: Guarded) -> None:
    call = machine.go(SetDumpAngle, "set_dump_angle", target_angle=-2.0)
    assert machine.end(call) is Outcome.ABORTED
    nowhere, wanted = pose(float("nan"), 0.0), to_line(AtPose(0, NoNumber()))
    call = machine.go(pose=nowhere)
    assert machine.end(call) is Outcome.ABORTED
    assert getattr(call.result, "error_msg", wanted) == wanted
    assert not machine.latched()


def test_refuse_is_told_with_a_reason(machine: Guarded) -> None:
    machine.be(refuse=["navigate_to_pose"])
    machine.until(lambda: "REJECTED" in _text(machine), "a refusal in the result")
    assert not machine.latched()


def _text(machine: Guarded) -> str:
    x, y = machine.place()
    call = machine.go(pose=pose(x + 0.2, y, 1.5708))
    machine.end(call)
    return str(getattr(call.result, "error_msg", "REJECTED"))


def test_dropped_feedback_does_not_end_a_goal(machine: Guarded) -> None:
    machine.be(drop_feedback=True)

    def silent() -> bool:
        machine.said.clear()
        x, y = machine.place()
        assert machine.end(machine.go(pose=pose(x, y + 3, 1.5708))) is Outcome.SUCCEEDED
        return not machine.said

    machine.until(silent, "a goal that succeeds without feedback")


def test_drift_is_no_stand_still_so_the_stop_latches(machine: Guarded) -> None:
    call = machine.driving()
    machine.be(drift=0.1)
    machine.until(lambda: machine.fault.get_subscription_count() > 0, "subscription")
    receipt = machine.stop(call)
    assert machine.end(call) is Outcome.ABORTED
    assert not receipt.confirmed and receipt.latched and receipt.detail == to_line(Moving())
    machine.until(machine.latched, "a latch")
    refused = machine.go()
    assert machine.end(refused) is Outcome.ABORTED
    again = machine.ros.call(Rearm, f"/{NAME}/rearm", Rearm.Request(), 20.0)
    assert again.error_code == "CAUSE_PERSISTS" and wire.known(again.error_msg).find(NotStill) is not None


def test_late_commands_come_late_and_the_receipt_tells_how_late(machine: Guarded) -> None:
    call = machine.driving()
    machine.be(late=10.0)  # 1 s of ours
    machine.be(late=10.0, refuse=["set_dump_angle"])
    machine.until(
        lambda: machine.end(machine.send(SetDumpAngle, "set_dump_angle", target_angle=-0.1)) is Outcome.REJECTED,
        "fault",
    )
    receipt = machine.stop(call)
    assert receipt.confirmed and receipt.seconds > 0.9
    assert receipt.travel_m > 0.5
    assert machine.end(call) is Outcome.CANCELED
    assert not machine.latched()


def test_missed_waypoints_reach_whoever_asked(machine: Guarded) -> None:
    machine.be(miss=[0])

    def missed() -> list[int]:
        x, y = machine.place()
        call = machine.go(FollowWaypoints, "follow_waypoints", poses=[pose(x, y + 1, 1.5708), pose(x, y + 2, 1.5708)])
        assert machine.end(call) is Outcome.SUCCEEDED  # as Nav2 has it; the subtask makes a failure of it
        return [getattr(one, "index", one) for one in call.result.missed_waypoints]

    machine.until(lambda: missed() == [0], "the missed waypoint")


def test_a_dead_machine_is_not_seen_to_stand(machine: Guarded) -> None:
    call = machine.driving()
    machine.be(die=0.1)
    machine.until(lambda: machine.process.returncode == 1, "death")
    assert machine.end(call) is Outcome.ABORTED
    machine.until(lambda: machine.receipts and not machine.receipts[-1].confirmed, "an unconfirmed stop")
    machine.until(machine.latched, "a latch")
    silent = machine.ros.call(Rearm, f"/{NAME}/rearm", Rearm.Request(), 20.0)
    assert silent.error_code == "CAUSE_PERSISTS" and wire.known(silent.error_msg).find(NotSeen) is not None
    machine.start(f"sim:{NAME}")
    machine.order()
    x, y = machine.place()
    assert machine.end(machine.go(pose=pose(x, y + 2, 1.5708))) is Outcome.SUCCEEDED


def test_a_machine_that_nobody_sees_is_not_moved_and_not_latched(machine: Guarded) -> None:
    machine.process.kill()
    machine.process.wait(10)
    machine.until(lambda: not machine.reported[-1].ready, "a gateway that is not ready")
    call = machine.go()
    assert machine.end(call) is Outcome.ABORTED
    machine.start(f"sim:{NAME}")
    machine.until(lambda: machine.reported[-1].ready, "a gateway that is ready")
    assert not machine.latched()
    x, y = machine.place()
    assert machine.end(machine.go(pose=pose(x, y + 2, 1.5708))) is Outcome.SUCCEEDED
