"""Excavators: an arm on an upper body that turns."""

from dataclasses import replace

from tms_msg_rp.action import (
    Excavate,
    PlanPose,
    Release,
    TmsRpZx200ChangePose,
    TmsRpZx200ExcavateSimple,
    TmsRpZx200ReleaseSimple,
)

from tms_rp.kind import Angles, MachineKind, Moves, PlanningAction
from tms_rp.kinds.backhoe import messages
from tms_rp.kinds.backhoe.digging import excavate, release
from tms_rp.kinds.backhoe.linkage import ArmAngles
from tms_rp.kinds.backhoe.manners import MANNERS
from tms_rp.kinds.backhoe.planner import NAMES, Backhoe
from tms_rp.plans import start_of


def _change_pose(planner: Backhoe, now: Angles, request: TmsRpZx200ChangePose.Goal) -> Moves:
    begin = ArmAngles(*now)
    return planner.carrying(begin, planner.change_pose(begin, messages.change_pose(request)))


def _plan_pose(planner: Backhoe, now: Angles, request: PlanPose.Goal) -> Moves:
    begin = start_of(request.previous, NAMES) or now
    asked = messages.change_pose(request)
    if request.orientation_tolerance > 0:
        asked = replace(asked, aside=request.orientation_tolerance)
    found = planner.change_pose(ArmAngles(*begin), asked)
    return replace(found, begin=begin, scales=(request.velocity_scale, request.acceleration_scale))


def _excavate(planner: Backhoe, now: Angles, request: Excavate.Goal) -> Moves:
    return excavate(planner, ArmAngles(*now), messages.dig(request))


def _excavate_simple(planner: Backhoe, now: Angles, request: TmsRpZx200ExcavateSimple.Goal) -> Moves:
    return _excavate(planner, now, Excavate.Goal(position_with_angle=request.position_with_angle))


def _release(planner: Backhoe, now: Angles, request: Release.Goal) -> Moves:
    return release(planner, ArmAngles(*now), messages.emptying(request))


def _release_simple(planner: Backhoe, now: Angles, request: TmsRpZx200ReleaseSimple.Goal) -> Moves:
    return _release(planner, now, Release.Goal(target_angle=request.target_angle))


KIND = MachineKind(
    NAMES,
    Backhoe,
    (
        PlanningAction("change_pose", TmsRpZx200ChangePose, _change_pose, True),
        PlanningAction("change_pose_plan", TmsRpZx200ChangePose, _change_pose, False),
        PlanningAction("plan_pose", PlanPose, _plan_pose, False, answers=True),
        PlanningAction("excavate", Excavate, _excavate, True),
        PlanningAction("excavate_plan", Excavate, _excavate, False),
        PlanningAction("release", Release, _release, True),
        # by the C++ system's types, with the usual figures
        PlanningAction("excavate_simple", TmsRpZx200ExcavateSimple, _excavate_simple, True),
        PlanningAction("excavate_simple_plan", TmsRpZx200ExcavateSimple, _excavate_simple, False),
        PlanningAction("release_simple", TmsRpZx200ReleaseSimple, _release_simple, True),
    ),
    MANNERS,
)
