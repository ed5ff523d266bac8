"""Planner, gateway and stand-in machine as real processes: motion, cancel, refusal, emergency stop."""

import math
import os
from collections import deque
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from control_msgs.action import FollowJointTrajectory
from geometry_msgs.msg import Point, TransformStamped
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool
from tf2_msgs.msg import TFMessage
from tms_msg_rc.msg import MachineState
from tms_msg_rp.action import (
    Excavate,
    ExecutePlans,
    PlanPose,
    TmsRpExcavator,
    TmsRpZx200ChangePose,
    TmsRpZx200ExcavateSimple,
    TmsRpZx200ReleaseSimple,
)
from tms_msg_rp.msg import TmsRpErrorCodes, TmsRpExcavatorJointValues, TmsRpZx200PositionWithAngle
from tms_msg_rp.srv import CheckMotion, GetScene
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint
from visualization_msgs.msg import Marker, MarkerArray

import programs
from conftest import rearm, wait_until
from tms_config.config import CONFIGS, load_site
from tms_config.models import MachineModel
from tms_config.reasons import AboveLimit
from tms_config.yaml_file import parse
from tms_control.reasons import PathBlocked
from tms_decision.reasons import MachineLatched, PressedByOthers
from tms_rc.latch_file import LatchFile
from tms_reason import wire
from tms_reason.reason import R
from tms_ros.client import Call
from tms_ros.goals import Outcome
from tms_ros.node import Ros
from tms_ros.packing import pack
from tms_rp.kinds.backhoe.planner import NAMES as ARM
from tms_rp.reasons import (
    JointBroken,
    JointsOld,
    JointsUnheard,
    MoveOf,
    OtherAngle,
    OutOfRange,
    PlanElsewhere,
    PlannedAnew,
)
from tms_runtime import environment

pytestmark = [
    pytest.mark.turns,
    pytest.mark.ros,
    pytest.mark.filterwarnings("ignore:module 'sre_:DeprecationWarning"),  # a parser that the ROS wheels bring
]
LIMIT = 60.0  # s for whatever must happen at all
SPEED = 2.0  # times real time
AWAY = 6000.0  # m, of the other machine: nobody tells its place again, so that it grows by all it may have driven since
SITE = """
name: rptest
domain: {domain}
ports: {{metrics: {port}}}
sim: {{speed: {speed}, seed: 1}}
services: {{}}
machines: {{{machine}: {{model: zx200}}, {mute}: {{model: zx200}}}}
peers: {{{machine}: {{leaf: v5, motions: true}}}}
forms: {{TmsRpExcavator: plan}}
"""
MACHINE, MUTE = "zx200_7", "zx200_8"  # names of their own: other tests may have a zx200 in the same domain
NAMES = ["swing_joint", "boom_joint", "arm_joint", "bucket_joint", "bucket_end_joint"]
START = (0.0, -0.8029, 1.9897, 0.8029, 0.0)
PLACE = parse(CONFIGS / "machines" / "zx200.yaml", MachineModel).start


class Rig:
    """Processes of our own, and a client that watches the machine."""

    def __init__(self, folder: Path, file: Path) -> None:
        self.environment = {**os.environ, **environment.environment(load_site(str(file)))}
        self.running: dict[str, programs.Program] = {}
        self.log = folder / "log.txt"
        self.ros = Ros("client")
        self.states: list[JointState] = []
        self.frames: set[tuple[str, str]] = set()
        self.said: list[str] = []
        self.ros.subscribe(JointState, f"/{MACHINE}/joint_states", self.states.append, depth=10)
        self.ros.subscribe(TFMessage, "/tf", self._framed, depth=10)
        self.stop = self.ros.publisher(Bool, f"/{MACHINE}/emg_stop")
        self.places = self.ros.publisher(TFMessage, "/tf", depth=10)

    def _framed(self, message: TFMessage) -> None:
        self.frames |= {(one.header.frame_id, one.child_frame_id) for one in message.transforms}

    def start(self, *names: str) -> None:
        for name in names:
            self.running[name] = programs.process(name, self.environment, self.log)

    def end_process(self, name: str, codes: tuple[int, ...] = (0,)) -> None:
        process = self.running.pop(name)
        process.terminate()
        try:
            assert process.wait(30) in codes, f"{name} did not end cleanly"
        finally:
            process.kill()

    def close(self) -> None:
        try:
            for name in list(self.running):
                self.end_process(name)
        finally:
            self.ros.close()

    def until(self, there: Callable[[], bool], what: str) -> None:
        wait_until(there, LIMIT, lambda: f"{what}; said {self.said[-3:]}\n{self.log.read_text()}")

    def send(self, action: Any, name: str, machine: str = MACHINE, **fields: Any) -> Call:
        peer = self.ros.peer(action, f"/{machine}/{name}")
        self.until(peer.ready, f"server {name}")
        return peer.send(action.Goal(**fields), on_feedback=lambda f: self.said.append(getattr(f, "state", "")))

    def change_pose(self, *angles: float, plan: bool = False, machine: str = MACHINE) -> Call:
        trajectory = JointTrajectory(joint_names=NAMES, points=[JointTrajectoryPoint(positions=list(angles))])
        name = "tms_rp_zx200_change_pose" + ("_plan" if plan else "")
        return self.send(TmsRpZx200ChangePose, name, machine, trajectory=trajectory)

    def cancel(self, call: Call, action: Any = TmsRpZx200ChangePose, name: str = "tms_rp_zx200_change_pose") -> None:
        self.ros.peer(action, f"/{MACHINE}/{name}").cancel(call)

    def end(self, call: Call) -> Outcome:
        self.until(lambda: call.outcome is not None, "end of the goal")
        assert call.outcome is not None
        return call.outcome

    def moving(self) -> bool:
        return bool(self.states) and any(abs(v) > 0.05 for v in self.states[-1].velocity)

    def reason(self, kind: type[R]) -> R | None:
        """The reason of this kind in what was said last."""
        return wire.known(self.said[-1]).find(kind) if self.said else None

    def with_other(self, away: float, bearing: float, there: Callable[[], bool]) -> Callable[[], bool]:
        """`there`, while the other machine is told to be at a place."""
        return lambda: bool(self.places.publish(at(away, bearing))) or there()

    def waits(self) -> bool:
        """Whether it has said that it plans anew, as its way is blocked."""
        return any(wire.known(said).find(PlannedAnew) is not None for said in self.said)

    def scene(self) -> GetScene.Response:
        """What the planner plans among."""
        self.until(lambda: self.ros.has_service(GetScene, f"/{MACHINE}/rp/get_scene"), "the service")
        return self.ros.call(GetScene, f"/{MACHINE}/rp/get_scene", GetScene.Request(), LIMIT)

    def meet_other(self) -> None:
        """Until the planner hears where the other machine is: not in its way."""
        known = self.with_other(AWAY, 0.0, lambda: any(one.kind == "machine" for one in self.scene().bodies))
        self.until(known, "the place of the other machine is heard")


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory, domain: int, first_port: int) -> Iterator[Rig]:
    """Planner, gateway and simulator of one machine, and the planner of another one that has neither."""
    folder = tmp_path_factory.mktemp("rig")
    file = folder / "site.yaml"
    file.write_text(SITE.format(domain=domain, port=first_port + 40, speed=SPEED, machine=MACHINE, mute=MUTE))
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ROS_DOMAIN_ID", str(domain))
        patch.setenv("TMS_STATE", str(folder / "state"))
        for key, value in environment.environment(load_site(str(file))).items():
            patch.setenv(key, value)
        made = Rig(folder, file)
        LatchFile(load_site(str(file)).state, MACHINE).arm()  # as a person has left it
        made.start(f"sim:{MACHINE}", f"{MACHINE}:rc", f"{MACHINE}:rp", f"{MUTE}:rp")
        try:
            made.until(lambda: bool(made.states) and bool(made.frames), "joint states and frames")
            assert made.states[0].position == pytest.approx(START)
            made.until(made.ros.peer(FollowJointTrajectory, f"/{MACHINE}/rc/follow_joint_trajectory").ready, "gateway")
            yield made
        finally:
            made.close()


@pytest.fixture
def machine(rig: Rig) -> Rig:
    """The machine in its start pose."""

    def there() -> bool:
        outcome = rig.end(rig.change_pose(*START))
        if outcome is not Outcome.SUCCEEDED:  # the test before this one has failed
            rig.places.publish(at(AWAY, 0.0))
            if rig.reason(MachineLatched):
                rearm(rig.ros, MACHINE)
        return outcome is Outcome.SUCCEEDED

    rig.until(there, "start pose")
    rig.said.clear()
    return rig


def test_change_pose_arrives_and_says_how_far_it_is(machine: Rig) -> None:
    assert machine.states[-1].name == NAMES
    frames = {("map", f"{MACHINE}/base_link"), (f"{MACHINE}/bucket_link", f"{MACHINE}/bucket_end_link")}
    machine.until(lambda: frames <= machine.frames, "frames of the machine")
    call = machine.change_pose(0.6, -0.6, 1.7, 100.0, 0.0)  # the bucket stays
    assert machine.end(call) is Outcome.SUCCEEDED
    assert call.result.error_code.val == TmsRpErrorCodes.SUCCESS
    assert machine.states[-1].position == pytest.approx((0.6, -0.6, 1.7, START[3], 0.0), abs=0.031)
    assert machine.said[0] == "PLANNING"
    assert machine.said[-1] == "SUCCEEDED"
    assert any(text.startswith("MOVE_OF number=1 count=1 ") for text in machine.said)


def test_a_machine_that_fell_silent_is_not_moved(machine: Rig) -> None:
    told = deque[MachineState](maxlen=1)
    machine.ros.subscribe(MachineState, f"/{MACHINE}/rc/state", told.append, latched=True)
    machine.end_process(f"sim:{MACHINE}")
    received = len(machine.states)
    machine.until(lambda: bool(told) and not told[0].ready, "a gateway that knows that its machine is gone")
    machine.until(
        lambda: machine.end(machine.change_pose(*START)) is Outcome.ABORTED and machine.reason(JointsOld),
        "refusal for old joint states",
    )
    machine.start(f"sim:{MACHINE}")
    machine.until(lambda: len(machine.states) > received, "joint states of the new simulator")
    machine.until(lambda: machine.end(machine.change_pose(*START)) is Outcome.SUCCEEDED, "motion afterwards")


def test_excavate_then_release(machine: Rig) -> None:
    soil = TmsRpZx200PositionWithAngle(position=Point(x=4.7, y=-0.4, z=0.1), theta_w=0.0)
    dig = machine.send(TmsRpZx200ExcavateSimple, "tms_rp_zx200_excavate_simple", position_with_angle=soil)
    assert machine.end(dig) is Outcome.SUCCEEDED
    assert sum(machine.states[-1].position[1:4]) == pytest.approx(math.pi, abs=0.06)  # the bucket is level
    assert any((reported := wire.known(text)).find(MoveOf) and reported.find(OtherAngle) for text in machine.said)
    opened = machine.send(TmsRpZx200ReleaseSimple, "tms_rp_zx200_release_simple", target_angle=-0.2)
    assert machine.end(opened) is Outcome.SUCCEEDED
    assert machine.states[-1].position[3] == pytest.approx(-0.2, abs=0.031)


def test_a_dig_that_is_blocked_is_planned_anew_from_where_it_was(machine: Rig) -> None:
    machine.meet_other()
    soil = TmsRpZx200PositionWithAngle(position=Point(x=-4.0, y=4.5, z=0.0), theta_w=1.6)
    dig = machine.send(Excavate, "tms_rp_zx200_excavate", position_with_angle=soil, depth=0.4, drag=1.0, lift=0.5)
    machine.until(machine.moving, "motion")

    machine.until(machine.with_other(7.0, 1.6, machine.waits), "a way that is blocked")
    assert dig.outcome is None and not machine.moving()
    machine.until(machine.with_other(AWAY, 1.6, lambda: dig.outcome is not None), "end of the dig")
    assert dig.outcome is Outcome.SUCCEEDED
    swing, boom, arm, bucket, _ = machine.states[-1].position
    assert swing == pytest.approx(math.atan2(4.53, -4.11), abs=0.06)
    assert boom + arm + bucket == pytest.approx(math.pi, abs=0.06)
    opened = machine.send(TmsRpZx200ReleaseSimple, "tms_rp_zx200_release_simple", target_angle=-0.2)
    assert machine.end(opened) is Outcome.SUCCEEDED  # what it carries would be kept level by later motions


def test_cancel_ends_with_the_machine_standing(machine: Rig) -> None:
    call = machine.change_pose(2.5, *START[1:])
    machine.until(machine.moving, "motion")
    machine.cancel(call)
    assert machine.end(call) is Outcome.CANCELED
    assert all(abs(velocity) < 0.01 for velocity in machine.states[-1].velocity)
    assert machine.states[-1].position[0] < 2.0
    assert call.result.error_code.val == TmsRpErrorCodes.FAILURE
    assert machine.end(machine.change_pose(*START)) is Outcome.SUCCEEDED


def test_one_motion_at_a_time_but_plans_always(machine: Rig) -> None:
    first = machine.change_pose(2.5, *START[1:])
    machine.until(machine.moving, "motion")
    assert machine.end(machine.change_pose(*START)) is Outcome.REJECTED
    machine.until(lambda: any(text.startswith("BUSY ") for text in machine.said), "the reason")
    planned = machine.change_pose(0.3, *START[1:], plan=True)
    assert machine.end(planned) is Outcome.SUCCEEDED
    assert any(text.startswith("PLANNED ") for text in machine.said)
    assert first.outcome is None
    machine.cancel(first)
    assert machine.end(first) is Outcome.CANCELED


def test_a_plan_never_moves_and_bad_goals_are_refused(machine: Rig) -> None:
    assert machine.end(machine.change_pose(1.0, *START[1:], plan=True)) is Outcome.SUCCEEDED
    call = machine.change_pose(0.0, 0.5, *START[2:])
    assert machine.end(call) is Outcome.ABORTED
    assert call.result.error_code.val == TmsRpErrorCodes.FAILURE
    assert machine.reason(OutOfRange) == OutOfRange((JointBroken("boom_joint", AboveLimit(0.5, -0.1)),))
    received = len(machine.states)
    machine.until(lambda: len(machine.states) > received + 10, "joint states")
    assert machine.states[-1].position == pytest.approx(START, abs=0.031)
    wrong = JointTrajectory(joint_names=["swing_joint"], points=[JointTrajectoryPoint(positions=[0.0])])
    controller = "upper_arm_controller/follow_joint_trajectory"
    assert machine.end(machine.send(FollowJointTrajectory, controller, trajectory=wrong)) is Outcome.REJECTED
    assert "code=-2 reason='the trajectory is for the joints swing_joint" in machine.log.read_text()


def at(away: float, bearing: float) -> TFMessage:
    """The other machine at a place: so far [m] from the machine, in a direction [rad]."""
    x, y, _ = PLACE
    frame = TransformStamped(child_frame_id=f"{MUTE}/base_link")
    frame.header.frame_id = "map"
    frame.transform.translation.x = x + away * math.cos(bearing)
    frame.transform.translation.y = y + away * math.sin(bearing)
    frame.transform.rotation.w = 1.0
    return TFMessage(transforms=[frame])


def test_what_comes_into_the_way_is_waited_for_and_the_motion_goes_on(machine: Rig) -> None:
    machine.meet_other()
    call = machine.change_pose(2.4, *START[1:])
    machine.until(machine.moving, "motion")
    machine.until(machine.with_other(7.0, 1.8, machine.waits), "a way that is blocked")
    (said, *_) = [known for said in machine.said if (known := wire.known(said)).find(PlannedAnew)]
    assert said.find(PathBlocked) is not None and not machine.moving()
    assert call.outcome is None and machine.states[-1].position[0] < 1.8
    machine.until(machine.with_other(AWAY, 1.8, lambda: call.outcome is not None), "end of the goal")
    assert call.outcome is Outcome.SUCCEEDED
    assert machine.states[-1].position[0] == pytest.approx(2.4, abs=0.031)


def test_the_scene_is_told_and_drawn_for_listeners(rig: Rig) -> None:
    rig.until(lambda: rig.scene().error_code == "", "the joints are known")
    assert len([one for one in rig.scene().bodies if one.kind == "own"]) == 5
    drawn: list[MarkerArray] = []
    rig.ros.subscribe(MarkerArray, f"/{MACHINE}/rp/scene", drawn.append)
    rig.until(lambda: bool(drawn), "markers")
    cubes = [one for one in drawn[0].markers if one.type == Marker.CUBE and one.action == Marker.ADD]
    assert len(cubes) >= 5 and cubes[0].header.frame_id == f"{MACHINE}/base_link"


def test_emergency_stop_ends_a_motion_until_it_is_released(machine: Rig) -> None:
    call = machine.change_pose(2.5, *START[1:])
    machine.until(machine.moving, "motion")
    machine.stop.publish(Bool(data=True))
    assert machine.end(call) is Outcome.ABORTED
    assert "emergency stop" in machine.said[-1] or PressedByOthers.code in machine.said[-1]  # whichever stops it first
    assert not machine.moving()
    assert machine.end(machine.change_pose(*START)) is Outcome.ABORTED
    machine.stop.publish(Bool(data=False))
    assert machine.end(machine.change_pose(*START)) is Outcome.ABORTED
    assert machine.reason(PressedByOthers)  # a person looks before it moves again
    machine.until(lambda: rearm(machine.ros, MACHINE), "armed machine")
    machine.until(lambda: machine.end(machine.change_pose(*START)) is Outcome.SUCCEEDED, "motion after the re-arm")


def test_a_planner_that_ends_takes_its_motion_with_it(machine: Rig) -> None:
    call = machine.change_pose(2.5, *START[1:])
    machine.until(machine.moving, "motion")
    machine.end_process(f"{MACHINE}:rp", (0, 1))  # 1: it has less time to leave than the machine needs to stand
    machine.until(lambda: not machine.moving(), "standing machine")
    assert machine.states[-1].position[0] < 2.4
    planner = machine.ros.peer(TmsRpZx200ChangePose, f"/{MACHINE}/tms_rp_zx200_change_pose")
    machine.until(lambda: call.outcome is Outcome.ABORTED or planner.left(), "news that the planner is gone")
    machine.start(f"{MACHINE}:rp")
    machine.until(lambda: machine.end(machine.change_pose(*START)) is Outcome.SUCCEEDED, "motion afterwards")


def test_a_motion_ends_with_a_planner_that_is_killed(machine: Rig) -> None:
    """Its client could not cancel it any more."""

    def answered() -> bool:  # goals before the new planner is found are lost
        call = machine.change_pose(*START)
        return call.wait_for(lambda: call.accepted, 2.0) and machine.end(call) is Outcome.SUCCEEDED

    machine.change_pose(2.5, *START[1:])
    machine.until(machine.moving, "motion")
    killed = machine.running.pop(f"{MACHINE}:rp")
    killed.kill()
    killed.wait(LIMIT)
    machine.until(lambda: not machine.moving(), "standing machine")
    assert machine.states[-1].position[0] < 2.4
    machine.start(f"{MACHINE}:rp")
    machine.until(answered, "motion afterwards")


def test_a_stored_plan_goes_on_where_it_was_broken_off(machine: Rig) -> None:
    there = (2.5, -0.4, 1.2, *START[3:])
    plans = [planned(machine, JointTrajectory(), *there)]
    first = machine.send(ExecutePlans, "tms_rp_zx200_execute_plans", plans=plans)
    machine.until(lambda: machine.moving() and machine.states[-1].position[0] > 0.3, "motion")
    machine.cancel(first, ExecutePlans, "tms_rp_zx200_execute_plans")
    assert machine.end(first) is Outcome.CANCELED
    assert 0.3 < machine.states[-1].position[0] < 2.3
    machine.said.clear()
    assert machine.end(machine.send(ExecutePlans, "tms_rp_zx200_execute_plans", plans=plans)) is Outcome.SUCCEEDED
    assert any(text.startswith("ADAPTED") and "GOES_ON" in text for text in machine.said)
    assert machine.states[-1].position == pytest.approx(there, abs=0.031)


def test_without_a_machine_there_is_a_reason(rig: Rig) -> None:
    rig.said.clear()
    assert rig.end(rig.change_pose(*START, machine=MUTE)) is Outcome.ABORTED
    assert rig.reason(JointsUnheard) == JointsUnheard(MUTE, f"/{MUTE}/joint_states", ARM)


def planned(machine: Rig, previous: JointTrajectory, *angles: float) -> JointTrajectory:
    target = JointTrajectory(joint_names=NAMES, points=[JointTrajectoryPoint(positions=list(angles))])
    call = machine.send(
        PlanPose, "tms_rp_zx200_plan_pose", previous=previous, trajectory=target, velocity_scale=1.0,
        acceleration_scale=1.0,
    )  # fmt: skip
    assert machine.end(call) is Outcome.SUCCEEDED
    made: JointTrajectory = call.result.plan
    return made


def test_stored_plans_are_executed_one_behind_the_other_and_not_from_elsewhere(machine: Rig) -> None:
    first = planned(machine, JointTrajectory(), 0.3, *START[1:])
    second = planned(machine, first, 0.3, -0.6, *START[2:])
    assert machine.states[-1].position == pytest.approx(START, abs=0.031)
    assert list(second.points[0].positions) == pytest.approx(list(first.points[-1].positions))
    both = machine.send(ExecutePlans, "tms_rp_zx200_execute_plans", plans=[first, second])
    assert machine.end(both) is Outcome.SUCCEEDED
    assert any(text.startswith("MOVE_OF number=2 count=2 ") for text in machine.said)
    there = (0.3, -0.6, *START[2:])
    assert machine.states[-1].position == pytest.approx(there, abs=0.031)
    again = machine.send(ExecutePlans, "tms_rp_zx200_execute_plans", plans=[first, second])
    assert machine.end(again) is Outcome.ABORTED
    elsewhere = machine.reason(PlanElsewhere)
    assert elsewhere is not None and elsewhere.joint == "swing_joint"
    assert machine.states[-1].position == pytest.approx(there, abs=0.031)


def test_a_primitive_of_version_6_moves_the_arm_until_it_is_cancelled(machine: Rig) -> None:
    def send(command: int, **fields: Any) -> Call:
        return machine.send(TmsRpExcavator, "tms_rp_excavator", command=command, **fields)

    asked, wanted = TmsRpExcavator.Goal, TmsRpExcavatorJointValues(joint_names=NAMES[:1], joint_values=[2.5])
    found = send(asked.CMD_PLAN_TO_JOINTS, joint_values=wanted)
    assert machine.end(found) is Outcome.SUCCEEDED and found.result.success
    assert machine.states[-1].position == pytest.approx(START, abs=0.031)
    call = send(asked.CMD_EXECUTE_PLAN, plan=found.result.plan)
    machine.until(machine.moving, "motion")
    assert machine.end(send(asked.CMD_EXECUTE_PLAN, plan=found.result.plan)) is Outcome.REJECTED
    assert machine.end(machine.change_pose(*START)) is Outcome.REJECTED  # one motion at a time, whoever asks
    machine.cancel(call, TmsRpExcavator, "tms_rp_excavator")
    assert machine.end(call) is Outcome.CANCELED
    assert (
        all(abs(velocity) < 0.01 for velocity in machine.states[-1].velocity) and machine.states[-1].position[0] < 2.0
    )
    assert (call.result.success, call.result.moveit_error_code) == (False, -7)


def test_a_check_plans_without_a_motion_and_while_another_goal_moves(machine: Rig) -> None:
    def answer(*angles: float) -> CheckMotion.Response:
        points = [JointTrajectoryPoint(positions=list(angles))]
        goal = TmsRpZx200ChangePose.Goal(trajectory=JointTrajectory(joint_names=NAMES, points=points))
        request = CheckMotion.Request(action="change_pose", goal=pack(goal))
        return machine.ros.call(CheckMotion, f"/{MACHINE}/rp/check_motion", request, LIMIT)

    call = machine.change_pose(2.5, *START[1:])
    machine.until(machine.moving, "motion")
    free, refused = answer(0.5, *START[1:]), answer(0.5, 0.5, *START[2:])
    assert not free.error_code and free.plan.points[-1].positions[0] == pytest.approx(0.5) and free.clearance > 0
    assert wire.known(refused.error_msg).find(OutOfRange) is not None and refused.lasting
    machine.cancel(call)
    assert machine.end(call) is Outcome.CANCELED
