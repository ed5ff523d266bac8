"""Loops over everything that configs/ declares: models, subtasks, processes."""

import math
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from shapely.geometry import Polygon

from conftest import PROJECT
from tms_config.config import CONFIGS, load_site
from tms_config.models import TURNED, MachineModel
from tms_config.processes import table
from tms_config.yaml_file import parse, read_yaml
from tms_control.links import Links
from tms_host.supervisor import render
from tms_kit.subtask_server import load
from tms_machine.record_lock import FLAG
from tms_machine.sensing import load_sensing

MODELS = sorted((CONFIGS / "machines").glob("*.yaml"))
SITES = [CONFIGS / "site.yaml", *sorted((CONFIGS / "sites").glob("*.yaml"))]
SUBTASKS = sorted(path.stem for path in (PROJECT / "services" / "tms_subtasks").glob("*.py") if path.stem != "__init__")


@pytest.mark.parametrize("path", MODELS, ids=lambda path: path.stem)
def test_model_is_consistent(path: Path) -> None:
    model = parse(path, MachineModel)
    starts = [*model.initial.items(), *(one for border in model.borders.values() for one in border.initial.items())]
    for name, angle in starts:
        assert model.joints[name].violation(angle) is None, f"{name} starts outside its limits"
    assert {model.subtask(action).run for action in model.subtasks} <= set(SUBTASKS)
    for border in model.borders.values():
        for action in TURNED:
            assert not getattr(border, action) or model.turned(action), f"no joint for {action}"


TURNING = {"mst110cr": (3.099, 1.892), "mst2200": (3.099, 1.892)}  # m, furthest corner of the body's mesh


@pytest.mark.parametrize("path", MODELS, ids=lambda path: path.stem)
def test_a_footprint_holds_the_body_at_any_angle(path: Path) -> None:
    model = parse(path, MachineModel)
    turns = [model.geometry[joint] for joint in ("swing_joint", "rotate_joint") if joint in model.geometry]
    if not turns:
        return
    (axis,) = turns
    if path.stem in TURNING:
        corner = math.hypot(*TURNING[path.stem])
    else:
        body = model.shapes[axis.child]
        corner = max(math.hypot(x, y) for x in (body.min[0], body.max[0]) for y in (body.min[1], body.max[1]))
    box = model.footprint["body"]
    sides = [axis.xyz[i] - box.min[i] for i in (0, 1)] + [box.max[i] - axis.xyz[i] for i in (0, 1)]
    assert min(sides) >= corner


@pytest.mark.parametrize("path", MODELS, ids=lambda path: path.stem)
def test_what_a_machine_looks_like_fits_its_bodies(path: Path) -> None:
    """Outlines cross themselves nowhere; in its start pose a machine stands on the ground, and has its size."""
    model = parse(path, MachineModel)
    assert {one.role for one in model.solids} == {"track", "body", "tool"} | (
        {"arm"} if model.kind in ("backhoe", "bulldozer") else set()
    )
    assert all(Polygon(one.outline).is_valid and all(low < high for low, high in one.y) for one in model.solids)
    start = np.array([[model.initial.get(name, 0.0) for name in model.joints]])
    frames = Links(model, {one.link for one in model.solids}).places(start)
    corners = [
        (one.link, (frames[one.link][0] @ (x, y, z, 1.0))[:3])
        for one in model.solids for x, z in one.outline for span in one.y for y in span
    ]  # fmt: skip
    assert abs(min(at[2] for _, at in corners)) < 0.1
    low = np.min([box.min for box in model.footprint.values()], axis=0) - 0.15
    high = np.max([box.max for box in model.footprint.values()], axis=0) + 0.15
    before = {"boom_link", "arm_link", "bucket_link", "lift_link", "blade_link"}  # what reaches out of a footprint
    outside = [(link, at) for link, at in corners if link not in before and not ((low < at) & (at < high)).all()]
    assert outside == []


def test_the_lock_of_a_record_ends_for_every_input() -> None:
    """tms:db knows when a lease has ended; a bare look at the flag would shut the input out for ever."""
    inputs = load_sensing(load_site(str(CONFIGS / "site.yaml"))).inputs
    assert [name for name, one in inputs.items() if FLAG in one.only_if] == []


USES = [
    pytest.param(path, action, id=action)
    for path in MODELS
    for action in parse(path, MachineModel).subtasks
]  # fmt: skip


@pytest.mark.parametrize(("path", "action"), USES)
def test_every_subtask_has_a_record_that_fits(path: Path, action: str) -> None:
    use = parse(path, MachineModel).subtask(action)
    records = {record["record_name"]: record for record in read_yaml(CONFIGS / "parameters" / path.name)}
    assert use.example in records, f"{path.name}: subtasks.{action}.example is no record of parameters/{path.name}"
    params = load(use.run).params
    if params is not None:
        params.model_validate({**records[use.example], **use.inputs})
        assert set(use.inputs) <= set(params.model_fields), "an input that the subtask does not know"


@pytest.mark.parametrize("path", MODELS, ids=lambda path: path.stem)
def test_a_model_can_do_the_same_behind_every_border(path: Path) -> None:
    borders = parse(path, MachineModel).borders
    actions = ("trajectory", "navigate_to_pose", "navigate_through_poses", "follow_waypoints", "set_dump_angle",
               "set_swing_angle", "joint_states", "odom", "cmd_vel")  # fmt: skip
    have = [{key for key in actions if getattr(border, key)} for border in borders.values()]
    assert all(one == have[0] for one in have)


@pytest.mark.parametrize("name", SUBTASKS)
def test_subtask_file_holds_one_subtask(name: str) -> None:
    subtask = load(name)
    assert subtask.timeout > 0
    text = (PROJECT / "services" / "tms_subtasks" / f"{name}.py").read_text()
    assert all(word not in text for word in ("rclpy", "pymongo", "prometheus_client", "zx200"))


@pytest.mark.parametrize("path", SITES, ids=lambda path: path.stem)
def test_process_table(path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TMS_STATE", str(tmp_path))
    site = load_site(str(path))
    site = replace(site, pc=next(iter(site.file.pcs), None))
    rows = table(site)
    assert len({row.full for row in rows}) == len({row.port for row in rows}) == len(rows)
    text = render(site, rows)
    assert all(f"-m tms_runtime.run {row.full}\n" in text for row in rows)
    assert "chmod=0600" in text and "inet_http_server" not in text


def test_imports_have_no_effects() -> None:
    """Importing a service must not start threads, read configuration or open anything."""
    code = (
        "import threading, importlib, pkgutil, sys\n"
        "layers = ('tms_config', 'tms_decision', 'tms_machine', 'tms_proof', 'tms_reason', 'tms_ros', 'tms_runtime')\n"
        "services = ('tms_db', 'tms_mc', 'tms_ts', 'tms_rp', 'tms_rc', 'tms_sim', 'tms_host', 'tms_cli',\n"
        "            'tms_ground', 'tms_soil', 'tms_work')\n"
        "for name in (*layers, 'tms_control', *services):\n"
        "    package = importlib.import_module(name)\n"
        "    for found in pkgutil.walk_packages(package.__path__, name + '.'):\n"
        "        importlib.import_module(found.name)\n"
        "print([t.name for t in threading.enumerate()])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=True,
                          env={"HOME": "/nonexistent", "PATH": "", "TMS_SITE": "/nonexistent/site.yaml"})  # fmt: skip
    assert done.stdout.strip() == "['MainThread']"
