"""The borders `physx` say of each machine what the stand-in of OperaSim-PhysX, written apart from them, does."""

import math
from itertools import pairwise

import pytest

from operasim import model as operasim
from operasim.outputs import Interval
from tms_config.config import CONFIGS
from tms_config.models import Border, MachineModel
from tms_config.yaml_file import parse

STEP = 0.02  # s, of the simulator's physics
KINDS = {
    "joint_state": ("joint_states", None), "odometry": ("odom", None),
    "pose": ("pose", "PoseStamped"), "global_pose": ("pose", "Odometry"),
}  # fmt: skip
MODELS = {path.stem: parse(path, MachineModel) for path in sorted((CONFIGS / "machines").glob("*.yaml"))}
SIMULATED = [name for name, model in MODELS.items() if "physx" in model.borders]


def border(name: str) -> Border:
    return MODELS[name].borders["physx"]


def period(declared: float) -> float:
    """Real seconds between two messages that the simulator sends every `declared` seconds."""
    interval = Interval(declared)
    sent = [step for step in range(1000) if interval.due(STEP)]
    (steps,) = {after - before for before, after in pairwise(sent)}
    return steps * STEP


@pytest.mark.parametrize("name", SIMULATED)
def test_its_sources(name: str) -> None:
    told = {}
    for topic, one in operasim.machine(name).outputs.items():
        if one.kind in KINDS:
            source, message = KINDS[one.kind]
            told[source] = topic.removeprefix("{name}/"), round(period(one.period), 3), message
    said = {
        source: (getattr(border(name), source), facts.period, facts.message if source == "pose" else None)
        for source, facts in border(name).sources.items()
    }
    assert said == told
    assert {facts.stamps for facts in border(name).sources.values()} == {"since_start"}


@pytest.mark.parametrize("name", SIMULATED)
def test_the_frame_of_its_base(name: str) -> None:
    (odometry,) = (one for one in operasim.machine(name).outputs.values() if one.kind == "odometry")
    assert odometry.child == border(name).base_frame == f"{border(name).frame_prefix}base_link"


@pytest.mark.parametrize("name", SIMULATED)
def test_its_joints_and_where_it_starts(name: str) -> None:
    model, there = MODELS[name], operasim.machine(name).joints
    names = {joint: border(name).joints.get(joint, joint) for joint in model.joints}
    assert set(names.values()) <= set(there)
    starts = {**model.initial, **border(name).initial}
    for joint, own in names.items():
        drive = there[own]
        target = 0.0 if drive is None else math.radians(drive.target)
        assert starts.get(joint, 0.0) == pytest.approx(target, abs=1e-4), joint


@pytest.mark.parametrize("name", SIMULATED)
def test_its_place_at_the_start(name: str) -> None:
    scenes = [operasim.scene(one) for one in ("SimpleScene", "SampleScene")]
    (placed,) = (scene.machines[name] for scene in scenes if name in scene.machines)
    assert MODELS[name].start == (*placed.place[:2], math.radians(placed.yaw))


@pytest.mark.parametrize("name", SIMULATED)
def test_its_commands(name: str) -> None:
    heard = {topic.removeprefix("{name}/"): one for topic, one in operasim.machine(name).inputs.items()}
    said = border(name)
    assert heard[str(said.cmd_vel)].kind == "twist"
    assert said.joint_cmd == next((topic for topic, one in heard.items() if one.kind == "joint_cmd"), None)
    assert said.emg_stop == next((topic for topic, one in heard.items() if one.kind == "emg_stop"), None)
    assert said.joint_angles == {one.joint: topic for topic, one in heard.items() if one.kind == "angle"}
