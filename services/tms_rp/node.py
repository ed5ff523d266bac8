"""Process `<machine>:rp`: plans motions and has the machine's gateway execute them."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from control_msgs.action import FollowJointTrajectory
from prometheus_client import Histogram
from tms_msg_rp.action import ExecutePlans
from tms_msg_rp.msg import TmsRpErrorCodes
from tms_msg_rp.srv import CheckMotion
from trajectory_msgs.msg import JointTrajectory

from tms_config.clock import monotonic
from tms_config.naming import process_of
from tms_machine.joint_states import JointStates
from tms_machine.permit import Permit, watch_server
from tms_machine.reasons import Aborted, Busy
from tms_reason import wire
from tms_reason.errors import SubtaskFailed, TmsError
from tms_reason.reason import Reason
from tms_reason.texts import text
from tms_ros.goals import Ended, Outcome
from tms_ros.server import AnyGoal
from tms_rp.checks import MotionChecks
from tms_rp.excavator import ExcavatorServer
from tms_rp.excavator_params import ExcavatorParams
from tms_rp.interventions import Interventions
from tms_rp.kind import Angles, Moves, PlanningAction
from tms_rp.kinds import load
from tms_rp.messages import follow
from tms_rp.mover import Mover
from tms_rp.neighbours import Neighbours
from tms_rp.plan import Plan
from tms_rp.reasons import (
    Adapted,
    GatewayAway,
    JointsOld,
    JointsUnheard,
    MotionCancelled,
    Planned,
    Planning,
    Succeeded,
)
from tms_rp.resuming import Resuming, Say
from tms_rp.scene import Scene
from tms_rp.scene_server import SceneServer
from tms_rp.scene_view import Area
from tms_rp.their_planner import TheirPlanner
from tms_rp.told_ground import ToldGround
from tms_rp.told_scene import ToldScene
from tms_rp.trajectory import Trajectory
from tms_rp.view import Nearest
from tms_rp.ways import Ways
from tms_runtime.app import App

FRESH = 1.0  # s, older joint states are no start for a motion
JOINTS_PERIOD = 0.25  # s between samples of joint states, to know their age

PLANNING = Histogram("tms_rp_planning_seconds", "From goal to trajectory", buckets=(0.001, 0.005, 0.02, 0.05, 0.2, 1))


def _stored(_planner: Any, _now: Angles, request: ExecutePlans.Goal) -> Moves:
    return Moves((), plans=tuple(request.plans))


EXECUTE = PlanningAction("execute_plans", ExecutePlans, _stored, True)


def start(app: App) -> None:
    """Serve `/<machine>/tms_rp_<model>_<action>`."""
    planner, model = Planner(app), app.site.file.machines[app.machine].model
    app.ros.poll_in_thread(JOINTS_PERIOD, planner.take_joints, "joints")
    actions = {action.name: action for action in (*planner.kind.actions, EXECUTE)}
    for action in actions.values():
        planner.serve(action, f"/{app.machine}/tms_rp_{model}_{action.name}")
    peer = app.site.file.peers.get(app.machine)
    if peer is not None and peer.motions and app.site.file.forms.TmsRpExcavator is not None:
        planner.serve_excavator(actions["plan_pose"])
    checks = MotionChecks(actions, planner.kind.joints, planner.joints, planner.planned, planner.nearest)
    app.ros.offer_slow(CheckMotion, f"/{app.machine}/rp/check_motion", checks.answer)
    SceneServer(app, app.site.model_of(app.machine), planner)
    app.ready_when(planner.unready)


class Planner:
    """Plans for one machine; one goal at a time may move it, plans without motion always work."""

    def __init__(self, app: App) -> None:
        self._app = app
        self._model = app.site.model_of(app.machine)
        assert self._model.planner is not None  # without it, the process table has no planner for the machine
        self.kind = load(self._model.planner)
        self._planner = self.kind.planner(self._model)
        self._ways, self._neighbours = Ways(self._model, self.kind), Neighbours(app)
        self._told, self._ground = ToldScene(app), ToldGround(app)
        self._rc = app.ros.peer(FollowJointTrajectory, f"/{app.machine}/rc/follow_joint_trajectory")
        watch_server(app.ros, app.pulse, app.machine, "rc")(self._rc)
        self._permit = Permit(app.ros, app.pulse, app.machine, "rp")
        self._resuming = Resuming(Mover(self._rc), Interventions(app.ros, app.machine), self._blocked, self._ways.late)
        peer = app.site.file.peers.get(app.machine)
        self._theirs = TheirPlanner(app, self.kind.joints) if peer is not None and peer.planner == "theirs" else None
        self.last: Trajectory | None = None  # what was planned last
        self._done: tuple[JointTrajectory, ...] = ()  # the stored plans that were executed last, to their end
        self._busy = False  # set on the executor thread, which accepts one goal after another
        self._joints = JointStates(app.ros, app.machine, app.site.border(app.machine), self.kind.joints)

    def take_joints(self) -> None:
        """Take the newest joint state."""
        self._joints.take()

    def unready(self) -> Reason | None:
        """Why no motion can be planned and executed now."""
        try:
            self.joints()
        except SubtaskFailed as error:
            return error.reason
        if missing := self._neighbours.unready():
            return missing
        return None if self._rc.ready() else GatewayAway(process_of(self._rc.name), self._rc.name)

    def joints(self) -> Angles:
        """The present joint angles of the arm.

        Raises:
            SubtaskFailed: JointsUnheard, JointsOld.
        """
        self._joints.take()
        last, topic = self._joints.last, self._joints.topic
        if last is None:
            raise SubtaskFailed(JointsUnheard(self._app.machine, topic, self.kind.joints))
        age = monotonic() - last[0]
        if age > FRESH:
            raise SubtaskFailed(JointsOld(self._app.machine, age, topic))
        return last[1]

    def serve(self, action: PlanningAction, name: str) -> None:
        """Serve one action under its full name."""
        self._app.ros.serve(
            action.type, name, lambda goal: self._run(action, goal), lambda _request: self._reserve(action)
        )

    def serve_excavator(self, plan: PlanningAction) -> None:
        """Serve primitives of the C++ system's version 6."""
        joints = {name: self._model.joints[name] for name in self.kind.joints}
        params = ExcavatorParams(self._app, joints, self.joints, self._planner.tool)
        ExcavatorServer(self._app, plan, EXECUTE, self._reserve, self._carry_out, lambda: params.settings)

    def _reserve(self, action: PlanningAction) -> Reason | None:
        """Take the machine for a goal that will move it, or tell why not."""
        if action.moves and self._busy:
            busy = Busy(self._app.process.full)
            self._app.log.warning("refused", action=action.name, reason=busy)
            return busy
        self._busy = self._busy or action.moves
        return None

    def _run(self, action: PlanningAction, goal: AnyGoal) -> Ended[Any]:
        def say(state: Reason) -> None:
            goal.publish(action.type.Feedback(state=wire.to_line(state)))

        outcome, plan = self._carry_out(action, goal, goal.request, say)
        code = TmsRpErrorCodes.SUCCESS if outcome is Outcome.SUCCEEDED else TmsRpErrorCodes.FAILURE
        answer = {"plan": follow(plan.made).trajectory} if action.answers and plan is not None else {}
        return outcome, action.type.Result(error_code=TmsRpErrorCodes(val=code), **answer)

    def _carry_out(
        self, action: PlanningAction, goal: AnyGoal, request: Any, tell: Callable[[Reason], None]
    ) -> tuple[Outcome, Plan | None]:
        """Do what `request` asks for a goal; the machine is free afterwards."""
        if action.moves:
            self._permit.hold(goal.uuid)
        try:
            return self._execute(action, goal, request, tell)
        finally:
            if action.moves:
                self._permit.drop()
                self._busy = False

    def _execute(
        self, action: PlanningAction, goal: AnyGoal, request: Any, tell: Callable[[Reason], None]
    ) -> tuple[Outcome, Plan | None]:
        def say(state: Reason, notes: tuple[Reason, ...] = ()) -> None:
            tell(Adapted(state, notes) if notes else state)

        def again(moves: Moves) -> Plan:
            return self._plan(action, self.joints(), moves)

        say(Planning())
        try:
            plan = self._planned(action, self.joints(), goal, request)
            if not action.moves:
                say(Planned(plan.made.duration), plan.notes)
                outcome = Outcome.SUCCEEDED
            else:
                self._planner.begins(self.joints(), plan.moves)
                outcome = self._moved(goal, plan, again, say)
        except TmsError as error:
            self._app.log.warning("failed", action=action.name, goal=goal.id, reason=error.reason)
            say(Aborted(error.reason, action.name))
            return Outcome.ABORTED, None
        say(Succeeded() if outcome is Outcome.SUCCEEDED else MotionCancelled())
        return outcome, plan

    def _moved(self, goal: AnyGoal, plan: Plan, again: Callable[[Moves], Plan], say: Say) -> Outcome:
        plans = plan.moves.plans
        self._done = () if plans else self._done
        outcome = self._resuming.move(goal, plan, again, say)
        if plans and outcome is Outcome.SUCCEEDED:
            self._done = plans
        return outcome

    def _blocked(self, made: Trajectory, seconds: float) -> Reason | None:
        """What has come into the way of a motion; without this machine's own place nobody knows, and it goes on."""
        try:
            scene = self._neighbours.scene(as_told=True)
        except SubtaskFailed:
            return None
        return self._ways.blocked(made, seconds, scene)

    def scene(self) -> Scene:
        """All that stands around the machine now.

        Raises:
            SubtaskFailed: something of it is not known.
        """
        told = self._told.scene()
        return replace(told, obstacles=(*self._neighbours.scene().obstacles, *told.obstacles))

    def pose(self) -> Angles:
        """The present angles of all joints; those that no goal moves are at 0.

        Raises:
            SubtaskFailed: JointsUnheard, JointsOld.
        """
        angles = dict(zip(self.kind.joints, self.joints(), strict=True))
        return tuple(angles.get(name, 0.0) for name in self._model.joints)

    def areas(self) -> list[Area]:
        """Where records say that the machine is to work."""
        return self._told.areas()

    def _planned(self, action: PlanningAction, now: Angles, goal: AnyGoal, request: Any) -> Plan:
        """A plan for a goal; of a plan to be stored the way is their planner's, where the site file says so."""
        moves = action.plan(self._planner, now, request)
        if self._theirs is not None and action.answers:
            moves = self._theirs.way(goal, request, moves)
        elif moves.plans != self._done:  # a leaf that is sent again after a loss must not begin anew
            moves = replace(moves, broken_off=True)
        return self._plan(action, now, moves)

    def planned(self, action: PlanningAction, now: Angles, request: Any) -> Plan:
        """A plan for a goal of an action, from angles of the arm [rad]."""
        return self._plan(action, now, action.plan(self._planner, now, request))

    def nearest(self, plan: Plan) -> Nearest | None:
        """Where a plan comes nearest to something in the scene as it is now."""
        return self._ways.nearest(plan.made, self.scene())

    def _plan(self, action: PlanningAction, now: Angles, moves: Moves) -> Plan:
        """A plan in the scene as it is now."""
        begun = monotonic()
        plan = self._ways.plan(now, moves, replace(self.scene(), ground=self._ground.around()))
        self.last = plan.made
        seconds = monotonic() - begun
        PLANNING.observe(seconds)
        self._app.log.info(
            "planned",
            action=action.name,
            moves=len(plan.made.stops),
            duration=round(plan.made.duration, 2),
            planning=round(seconds, 4),
            notes=[text(note, "en") for note in plan.notes],
        )
        return plan
