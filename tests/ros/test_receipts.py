"""A receipt says *confirmed* only of a machine that stands, whatever the machine does and reports.

The stand-in tells its true motion on a way of its own. Each of these has fooled receipts once.
"""

import json
import threading
import time
from collections.abc import Iterator
from typing import Any

import pytest
import yaml
from builtin_interfaces.msg import Duration
from control_msgs.action import FollowJointTrajectory
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, String
from tms_msg_rc.msg import MachineState, StopReceipt
from tms_msg_rc.srv import Rearm, StopMachine
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

import programs
from conftest import GATEWAYS_ONLY, Mesh, mesh_apart, wait_until
from tms_config.config import load_site
from tms_decision.reasons import DrivenByHand, LeftStandStill
from tms_proof.reasons import Stalled
from tms_rc.reasons import Rival, StrangeType
from tms_reason import wire
from tms_reason.reason import Foreign
from tms_reason.wire import to_line
from tms_ros.client import Call
from tms_ros.node import Ros

pytestmark = [pytest.mark.ros, pytest.mark.timeout(300)]
LIMIT = 60.0  # s for whatever must happen at all
SWING = 1.2  # rad
MOVES = 0.05  # rad/s: clearly on its way
STANDS = 0.011  # rad/s, the limit of the model and what 25 Hz of the truth add to it
WINDOW = 0.2  # s of standing that a receipt claims
AFTER = 1.0  # s after it in which nothing may move either


def seconds(stamp: Any) -> float:
    """A ROS time in s since 1970."""
    return float(stamp.sec + stamp.nanosec * 1e-9)


class Machine:
    """The stand-in as it truly is, and what its gateway says."""

    def __init__(self, mesh: Mesh, ros: Ros) -> None:
        self.mesh, self.ros = mesh, ros
        self.changed = threading.Condition()
        self.truth: list[tuple[float, float]] = []  # s since 1970, fastest joint rad/s
        self.reported = 0.0  # s since 1970, stamp of the last joint states
        self.state: Any = None
        self.seen = 0  # states so far
        self.receipts: list[Any] = []
        self.told: set[float] = set()  # stamps of the receipts of earlier tests: a gateway that starts tells them again
        ros.subscribe(JointState, "/zx200/sim/truth", self._on_truth, depth=50)
        ros.subscribe(JointState, "/zx200/joint_states", self._on_report, depth=5)
        ros.subscribe(MachineState, "/zx200/rc/state", self._on_state, latched=True)
        ros.subscribe(StopReceipt, "/zx200/rc/receipts", self._on_receipt, depth=20, latched=True)
        self._fault = ros.publisher(String, "/zx200/sim/fault")
        self.button = ros.publisher(Bool, "/emergency_signal")
        self.emergency = ros.publisher(Bool, "/zx200/emg_stop")
        self.gateway = ros.peer(FollowJointTrajectory, "/zx200/rc/follow_joint_trajectory")
        self.own = ros.peer(FollowJointTrajectory, "/zx200/upper_arm_controller/follow_joint_trajectory")
        self.until(lambda: len(self.truth) > 10, "the true motion")

    def _on_truth(self, message: Any) -> None:
        speeds = [abs(speed) for name, speed in zip(message.name, message.velocity, strict=True) if "joint" in name]
        with self.changed:
            self.truth.append((seconds(message.header.stamp), max(speeds)))
            self.changed.notify_all()

    def _on_report(self, message: Any) -> None:
        with self.changed:
            self.reported = seconds(message.header.stamp)
            self.changed.notify_all()

    def _on_state(self, state: Any) -> None:
        with self.changed:
            self.state, self.seen = state, self.seen + 1
            self.changed.notify_all()

    def _on_receipt(self, receipt: Any) -> None:
        with self.changed:
            self.receipts += [receipt] if seconds(receipt.stamp) not in self.told else []
            self.changed.notify_all()

    def until(self, holds: Any, what: str) -> None:
        with self.changed:
            assert self.changed.wait_for(holds, LIMIT), f"not within {LIMIT} s: {what}"

    def be(self, **fault: object) -> None:
        self._fault.publish(String(data=json.dumps(fault)))

    def arm(self) -> None:
        """In order again, standing and armed."""
        self.button.publish(Bool(data=False))
        self.be()
        self.until(lambda: abs(self.truth[-1][0] - self.reported) < 1.0, "reports by the clock of the truth")
        seen = self.seen + 2
        self.until(lambda: self.seen >= seen, "what the gateway makes of them")

        def armed() -> bool:
            first = self.ros.call(Rearm, "/zx200/rearm", Rearm.Request(), 30)
            if first.error_code == "NOT_STOPPED":
                return bool(self.state.ready and not self.state.moving)
            return bool(self.ros.call(Rearm, "/zx200/rearm", Rearm.Request(token=first.token), 30).armed)

        wait_until(armed, LIMIT, "zx200 is armed", every=0.2)
        self.until(lambda: self.state.armed and self.state.ready, "ready")
        self.forget_receipts()

    def forget_receipts(self) -> None:
        """Only later ones count from now on."""
        with self.changed:
            self.told.update(seconds(receipt.stamp) for receipt in self.receipts)
            del self.receipts[:]

    def swing(self, peer: Any = None, duration: int = 5) -> Call:
        """A long swing to the other side, by the gateway if nothing else is said."""
        peer = peer or self.gateway
        peer.wait_ready(LIMIT)
        joints = dict(zip(self.state.joint_names, self.state.positions, strict=True))
        goal = JointTrajectory(joint_names=list(joints))
        joints["swing_joint"] += SWING if joints["swing_joint"] < 0.5 else -SWING
        goal.points = [JointTrajectoryPoint(positions=list(joints.values()), time_from_start=Duration(sec=duration))]
        call: Call = peer.send(FollowJointTrajectory.Goal(trajectory=goal))
        return call

    def wait_moving(self, call: Call) -> None:
        self.until(lambda: self.truth[-1][1] > MOVES or call.outcome is not None, "it moves")
        assert call.outcome is None, call.result

    def wait_receipt(self) -> Any:
        self.until(lambda: bool(self.receipts), "a receipt")
        return self.receipts[0]

    def moved(self, receipt: Any) -> float:
        """Fastest true motion [rad/s] in the window that a confirmed receipt claims, and shortly after it."""
        end = seconds(receipt.stamp) + receipt.seconds
        self.until(lambda: self.truth[-1][0] > end + AFTER, "more of the true motion")
        return max(speed for at, speed in self.truth if end - WINDOW < at < end + AFTER)

    def honest(self, receipt: Any) -> None:
        """Confirmed and standing, or not confirmed and latched."""
        if receipt.confirmed:
            assert self.moved(receipt) < STANDS, receipt
        else:
            self.until(lambda: bool(self.state.latch), "a latch")
            assert receipt.latched and receipt.detail


@pytest.fixture(scope="module")
def machine(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Machine]:
    """A zx200 with its gateway; no scheduler, database or console."""
    with mesh_apart(tmp_path_factory.mktemp("receipts"), **GATEWAYS_ONLY, sim={"speed": 1.0}) as mesh:
        mesh.tms("up")
        try:
            ros = Ros("tms_tests_receipts")
            yield Machine(mesh, ros)
            ros.close()
        finally:
            mesh.tms("down")


@pytest.fixture(autouse=True)
def in_order(machine: Machine) -> Iterator[None]:
    machine.until(lambda: machine.state is not None, "the gateway")
    machine.arm()
    yield
    machine.be()


def test_a_machine_that_was_never_armed_is_latched(machine: Machine) -> None:
    """The first start of a gateway: the fixture had to re-arm it."""
    assert json.loads((machine.mesh.state / "rc" / "zx200.armed").read_text())["armed"] is True


LIES: list[dict[str, Any]] = [
    {"zero_velocity": True}, {"frozen_stamp": True}, {"mute": ["swing_joint"]}, {"second_publisher": True},
    {"replay": True}, {"nan": True}, {"back_in_time": 5.0},
]  # fmt: skip


@pytest.mark.turns
@pytest.mark.parametrize("lie", LIES, ids=lambda lie: next(iter(lie)))
def test_a_machine_that_coasts_and_lies_is_not_believed(machine: Machine, lie: dict[str, Any]) -> None:
    """It goes on for 3 s after the cancel, and says something else."""
    call = machine.swing()
    machine.wait_moving(call)
    machine.be(coast=3.0, **lie)
    machine.gateway.cancel(call)
    machine.honest(machine.wait_receipt())


def test_a_stop_in_the_dead_time_is_proven_after_it(machine: Machine) -> None:
    call = machine.swing()
    machine.until(lambda: bool(machine.state.goal) or call.outcome is not None, "the goal is under way")
    assert call.outcome is None, call.result
    machine.gateway.cancel(call)
    receipt = machine.wait_receipt()
    machine.honest(receipt)
    assert receipt.confirmed and receipt.seconds > 0.9


def test_a_software_stop_in_the_dead_time_that_is_ignored(machine: Machine) -> None:
    machine.be(ignore_emg_stop=True, ignore_cancel=True)
    call = machine.swing(duration=25)
    machine.until(lambda: call.feedback is not None or call.outcome is not None, "the controller works on the goal")
    assert call.outcome is None, call.result
    machine.button.publish(Bool(data=True))
    receipt = machine.wait_receipt()
    machine.honest(receipt)
    assert not receipt.confirmed


def test_a_goal_waits_for_a_long_proof(machine: Machine) -> None:
    """Nothing shows that a stuck machine obeys, so its stops take long to prove: the next goal comes meanwhile."""

    def stop(after: float) -> threading.Thread:
        machine.until(lambda: machine.truth[-1][0] > after, "time to pass")
        request = StopMachine.Request(cause="a test", orderly=True)
        thread = threading.Thread(target=machine.ros.call, args=(StopMachine, "/zx200/rc/stop", request, LIMIT))
        thread.start()
        return thread

    machine.be(stall=0.0)
    call, begun = machine.swing(duration=5), machine.truth[-1][0]
    first = stop(begun + 2.0)
    second = stop(begun + 6.0)
    machine.until(lambda: call.outcome is not None, "the first goal is over")
    machine.be()
    assert second.is_alive()
    machine.wait_moving(machine.swing())
    first.join(LIMIT)
    second.join(LIMIT)


def test_a_joint_that_is_not_heard_after_a_restart_is_unknown(machine: Machine) -> None:
    call = machine.swing()
    machine.wait_moving(call)
    machine.be(mute=["boom_joint"], coast=3.0)
    machine.mesh.tms("restart", "zx200:rc")
    for receipt in [machine.wait_receipt()]:
        machine.honest(receipt)
    machine.until(lambda: bool(machine.state.latch), "a latch")


def test_a_goal_behind_the_gateways_back_is_stopped(machine: Machine) -> None:
    """At the machine's own server, while the gateway has it latched."""
    machine.button.publish(Bool(data=True))
    machine.until(lambda: bool(machine.state.latch), "latched")
    machine.wait_receipt()
    machine.button.publish(Bool(data=False))
    machine.forget_receipts()

    def accepted() -> bool:
        machine.emergency.publish(Bool(data=False))  # somebody else releases it
        calls.append(machine.swing(machine.own))
        machine.until(lambda: calls[-1].accepted or calls[-1].outcome is not None, "an answer")
        return calls[-1].accepted

    calls: list[Call] = []
    wait_until(accepted, LIMIT, "the machine takes the goal", every=0.2)
    call = calls[-1]
    machine.until(lambda: call.outcome is not None, "the end of the goal")
    receipt = machine.wait_receipt()
    assert not receipt.confirmed and receipt.detail == to_line(LeftStandStill())
    assert abs(machine.state.velocities[0]) < SWING and call.outcome is not None and call.outcome.name != "SUCCEEDED"


def test_a_stopped_machine_that_creeps_is_stopped_again(machine: Machine) -> None:
    machine.be(creep=0.05)
    call = machine.swing()
    machine.wait_moving(call)
    machine.gateway.cancel(call)
    machine.until(lambda: any(one.detail == to_line(LeftStandStill()) for one in machine.receipts), "it is noticed")
    machine.until(lambda: bool(machine.state.latch), "latched")


def test_a_person_may_drive_a_machine_that_was_taken(machine: Machine) -> None:
    machine.mesh.tms("take", "zx200", "--by", "mina")
    call = machine.swing()
    machine.until(lambda: call.outcome is not None, "refused")
    assert call.result.error_string == to_line(DrivenByHand(Foreign("mina"), "zx200"))
    call = machine.swing(machine.own, duration=4)
    machine.until(lambda: call.outcome is not None, "its end")
    assert call.outcome is not None and call.outcome.name == "SUCCEEDED"
    given = json.loads(machine.mesh.tms("give-back", "zx200", "--json").stdout)
    assert given["confirmed"] is True and machine.state.by_hand == ""


def test_a_stall_is_told_at_once(machine: Machine) -> None:
    machine.be(stall=1.5)
    begun = time.monotonic()
    call = machine.swing(duration=20)
    machine.until(lambda: call.outcome is not None, "its end")
    stalled = wire.known(call.result.error_string).find(Stalled)
    assert stalled is not None and stalled.joint == "swing_joint"
    assert time.monotonic() - begun < 20.0


def test_a_second_gateway_does_not_serve(machine: Machine, tmp_path_factory: pytest.TempPathFactory) -> None:
    folder = tmp_path_factory.mktemp("second")
    data = yaml.safe_load(machine.mesh.site.read_text())
    data["ports"]["metrics"] += 30
    (folder / "site.yaml").write_text(yaml.safe_dump(data))
    env = {**machine.mesh.env, "TMS_SITE": str(folder / "site.yaml"), "TMS_STATE": str(folder / "state")}
    from tms_config.processes import find
    from tms_runtime import metrics

    second = programs.process("zx200:rc", env, folder / "log.txt")
    try:
        machine.until(lambda: isinstance(wire.of(machine.state.reason), Rival), "the first one says so")
        row = find(load_site(str(folder / "site.yaml")), "zx200:rc")
        wait_until(
            lambda: isinstance(metrics.unready(row), Rival), LIMIT,
            "the second one says so",
        )  # fmt: skip
        assert "another gateway for zx200" in machine.mesh.tms("status", expect=1).stdout
        assert not (folder / "state" / "rc").exists()
    finally:
        second.terminate()
        second.wait(30)
    machine.until(lambda: machine.state.ready, "ready again")


def test_a_source_that_returns_under_another_type_is_named(machine: Machine) -> None:
    machine.mesh.tms("stop-process", "sim:zx200")
    machine.until(lambda: not machine.state.ready, "it is silent")
    stranger = Ros("stranger")
    stranger.publisher(String, "/zx200/joint_states")
    try:
        machine.until(lambda: isinstance(wire.of(machine.state.reason), StrangeType), "the type is named")
        strange = wire.known(machine.state.reason)
        assert strange.args["found"] == "std_msgs/msg/String" and strange.args["wanted"] == "sensor_msgs/msg/JointState"
    finally:
        stranger.close()
        machine.mesh.tms("start", "sim:zx200")
    machine.until(lambda: machine.state.ready, "ready again")
