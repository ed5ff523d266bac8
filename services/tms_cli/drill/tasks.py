"""An endless task for each machine, of long motions, and the records that it needs. Pure logic.

Models with primitives of the C++ system's version 6 do these, by its leaves; the others do subtasks of version 5. An
excavator of the former moves along plans that rest in records meanwhile.
"""

import math
from collections.abc import Mapping
from typing import Any
from xml.sax.saxutils import quoteattr

from tms_config.config import Site
from tms_config.models import MachineModel
from tms_machine.geometry import about

SWING = 1.2  # rad to each side
TURN = 70.0  # deg to each side, for a single joint
LIFT = 0.3  # rad
WAY = 15.0  # m
TIPPED = -0.9  # rad
BLADE = [-0.35, 0.1, 0.35]  # rad, of lift, tilt and angle
TURNS: tuple[tuple[str, str, Any, Any], ...] = (  # subtask, field of its record, there and back
    ("release_soil", "target_angle", TIPPED, 0.0),
    ("swing", "target_angle", SWING, -SWING),
    ("blade_control", "goal_position", BLADE, [-angle / 3 for angle in BLADE]),
)

Records = dict[str, dict[str, Any]]
Leaves = list[tuple[str, str]]  # subtask, record
PRIMITIVES: Mapping[str, tuple[str, str, str]] = {  # kind of machine -> leaf of version 6, its ports for what and of
    "backhoe": ("LeafNodeExcavator", "primitive_name", "target_record_name"),
    "crawler_dump": ("LeafNodeCrawlerDump", "primitive_name", "record_name"),
    "bulldozer": ("LeafNodeBulldozer", "primitive_name", "record_name"),
}
PRIMITIVE = "primitive_"  # how the names of primitives begin
PLANS = "change_pose_plan"  # the subtask file that moves nothing


def task(site: Site, machine: str) -> tuple[str, Records]:
    """The tree, and records by name."""
    model = site.model_of(machine)
    leaves, records = _tracks(site, machine, model) if not model.planner else _plans(model) or _arm(model)
    node, what, of = f"LeafNode{site.file.machines[machine].model.capitalize()}", "subtask_name", "record_name"
    if leaves[0][0].startswith(PRIMITIVE):
        node, what, of = PRIMITIVES[model.kind]
    actions = "".join(
        f"<Action ID={quoteattr(node)} model_name={quoteattr(machine)} {what}={quoteattr(subtask)} "
        f"{of}={quoteattr(record)}/>"
        for subtask, record in leaves
    )
    return (
        '<root main_tree_to_execute="Drill"><BehaviorTree ID="Drill">'
        f'<Repeat num_cycles="-1"><Sequence>{actions}</Sequence></Repeat></BehaviorTree></root>',
        records,
    )


def _arm(model: MachineModel) -> tuple[Leaves, Records]:
    pose = _subtask(model, "change_pose", plan_only=False)
    swing = _subtask(model, "sample_joint", joint="swing_joint")
    field = str(model.subtask(swing).inputs["field"])
    start = {"trajectory": 1, **model.initial}
    boom = model.initial["boom_joint"]
    records: Records = {
        "drill_left": {**start, "swing_joint": SWING},
        "drill_right": {**start, "swing_joint": -SWING, "boom_joint": boom + LIFT},
        "drill_swing_left": {field: TURN},
        "drill_swing_right": {field: -TURN},
    }
    return [
        (pose, "drill_left"), (pose, "drill_right"), (swing, "drill_swing_left"), (swing, "drill_swing_right"),
    ], records  # fmt: skip


def _plans(model: MachineModel) -> tuple[Leaves, Records] | None:
    """The motions of an arm along plans; None for a model without primitives."""
    if not any(model.subtask(name).run == PLANS for name in model.subtasks):
        return None
    plan = _subtask(model, PLANS)
    move = _subtask(model, "change_pose_execute_from_plan", retime=False)
    boom = model.initial["boom_joint"]
    targets = {
        "drill_left": {**model.initial, "swing_joint": SWING},
        "drill_right": {**model.initial, "swing_joint": -SWING, "boom_joint": boom + LIFT},
    }
    whole = {"planning_group": "manipulator", "velocity_scale": 1.0, "acceleration_scale": 1.0}
    records: Records = {
        name: {**whole, "waypoints": [{"type": "joint_values_absolute", "data": target}]}
        for name, target in targets.items()
    }
    return [(what, record) for record in records for what in (plan, move)], records


def _tracks(site: Site, machine: str, model: MachineModel) -> tuple[Leaves, Records]:
    x, y, yaw = site.start_of(machine)
    drive = _subtask(model, "navigate_anywhere", angles="quaternion")
    records: Records = {
        "drill_far": _place(x + WAY * math.cos(yaw), y + WAY * math.sin(yaw), yaw),
        "drill_near": _place(x, y, yaw + math.pi),
    }
    leaves = [(drive, "drill_far"), (drive, "drill_near")]
    for run, field, there, back in TURNS:
        if any(model.subtask(name).run == run for name in model.subtasks):
            records |= {f"drill_{run}": {field: there}, f"drill_{run}_back": {field: back}}
            leaves += [(_subtask(model, run), f"drill_{run}"), (_subtask(model, run), f"drill_{run}_back")]
    return leaves, records


def _place(x: float, y: float, yaw: float) -> dict[str, Any]:
    return {"x": x, "y": y, "z": 0.0, **dict(zip(("qx", "qy", "qz", "qw"), about("z", yaw), strict=True))}


def _subtask(model: MachineModel, run: str, **inputs: Any) -> str:
    """The model's subtask that runs a file with these inputs; a primitive where there is one."""
    uses: Mapping[str, Any] = {name: model.subtask(name) for name in model.subtasks}
    fit = [name for name, use in uses.items() if use.run == run and inputs.items() <= dict(use.inputs).items()]
    return next((name for name in fit if name.startswith(PRIMITIVE)), fit[0])
