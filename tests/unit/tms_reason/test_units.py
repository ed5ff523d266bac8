"""Every number that a subtask takes from a record has a unit, or is known to have none."""

import pytest

from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_kit.subtask import load
from tms_reason.units import unit

WITHOUT = {  # flags, quaternions, shares, and what holds fields of its own
    "trajectory", "pose", "position_with_angle", "qx", "qy", "qz", "qw", "goal_qx", "goal_qy", "goal_qz", "goal_qw",
    "velocity_scale", "acceleration_scale", "constraints", "waypoints",
}  # fmt: skip
TEXTS = {
    "angles",
    "joint",
    "field",
    "plan_only",
    "angle",
    "read_direction",
    "planning_group",
    "previous_target_record_name",
    "retime",
    "output",
    "blade_hold",
    "excavator",
    "job",
    "trucks",
}  # inputs, and what is picked from another field
MODELS = sorted(path.stem for path in (CONFIGS / "machines").glob("*.yaml"))


@pytest.mark.parametrize("name", MODELS)
def test_the_fields_of_subtasks_have_units(name: str) -> None:
    model = parse(CONFIGS / "machines" / f"{name}.yaml", MachineModel)
    uses = [model.subtask(action) for action in model.subtasks]
    wanted = {field for use in uses if (params := load(use.run).params) for field in params.model_fields}
    picked = {str(use.inputs["field"]) for use in uses if "field" in use.inputs}
    left = {field for field in (wanted | picked) - TEXTS if not unit(field)} - WITHOUT
    assert not left, "give them units in tms_reason/units.py"


def test_units() -> None:
    assert [unit(name) for name in ("x", "swing_joint", "zx200_boom_goal_pos", "yaw", "TAKEN")] == [
        "m", "rad", "deg", "deg", "",
    ]  # fmt: skip
