"""An endless task for each machine, of long motions, and the records that it needs. Pure logic."""

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


def task(site: Site, machine: str) -> tuple[str, Records]:
    """The tree, and records by name."""
    model = site.model_of(machine)
    leaves, records = _arm(model) if model.planner else _tracks(site, machine, model)
    actions = "".join(
        f"<Action ID={quoteattr(f'LeafNode{site.file.machines[machine].model.capitalize()}')} "
        f"model_name={quoteattr(machine)} subtask_name={quoteattr(subtask)} record_name={quoteattr(record)}/>"
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
    """The model's subtask that runs a file with these inputs."""
    uses: Mapping[str, Any] = {name: model.subtask(name) for name in model.subtasks}
    return next(name for name, use in uses.items() if use.run == run and inputs.items() <= dict(use.inputs).items())
