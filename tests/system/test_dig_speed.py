"""A bucket that is dug ten times as fast as real brings as much soil."""

import os
import time
from collections.abc import Callable
from pathlib import Path

import pytest
import yaml
from tms_msg_ground.msg import SoilLoad

from conftest import NO_CONSOLE, PROJECT, Mesh, claimed_domain, node_in, ports_of, running, site_data, wait_until
from tms_machine.stamps import seconds

pytestmark = [pytest.mark.system, pytest.mark.timeout(900)]
OFF = 0.03  # of the load
PASS = """<root main_tree_to_execute="Pass"><BehaviorTree ID="Pass"><Sequence>
  <Action ID="LeafNodeZx200" model_name="zx200" record_name="initial_pose" subtask_name="subtask_zx200_change_pose"/>
  <Action ID="LeafNodeZx200" model_name="zx200" record_name="here" subtask_name="subtask_zx200_excavate_simple"/>
</Sequence></BehaviorTree></root>"""
HERE = {"model_name": "zx200", "record_name": "here", "type": "static", "position_with_angle": 1, "x": 0.0, "y": -6.0,
        "z": 0.0, "theta_w": 0.9, "depth": 0.9, "drag": 1.0}  # fmt: skip


def dug(folder: Path, speed: float) -> float:
    """Loose soil [m3] in the bucket after one pass of stand-ins that live so fast."""
    folder.mkdir()
    files = {name: folder / name for name in ("site.yaml", "records.yaml", "pass.xml")}
    with claimed_domain() as domain:
        data = site_data(
            domain, ports_of(domain), sim={"speed": speed}, ground={"area": [-30.0, -30.0, 10.0, 20.0]}, **NO_CONSOLE
        )
        files["site.yaml"].write_text(yaml.safe_dump(data))
        files["records.yaml"].write_text(yaml.safe_dump([HERE]))
        files["pass.xml"].write_text(PASS)
        with running(Mesh(files["site.yaml"], folder / "state")) as mesh, node_in(mesh) as ros:
            mesh.tms("param", "load", str(PROJECT / "configs" / "parameters" / "zx200.yaml"))
            mesh.tms("param", "load", str(files["records.yaml"]))
            mesh.tms("task", "add", str(files["pass.xml"]))
            mesh.tms("run", "1", "--wait", limit=200)
            return load_after(ros.sample(SoilLoad, "/zx200/soil_load"), time.time())


def load_after(told: Callable[[], list[SoilLoad]], ended: float) -> float:
    """The load that a ground tells which has taken all until a time."""
    found: list[float] = []

    def look() -> bool:
        found.extend(one.loose for one in told() if seconds(one.stamp) >= ended)
        return bool(found)

    wait_until(look, 60, "tms:ground tells the load")
    return found[0]


@pytest.mark.skipif("TMS_EARTH" not in os.environ, reason="make nightly")
def test_a_pass_brings_as_much_at_ten_times_the_speed(tmp_path: Path) -> None:
    real, fast = dug(tmp_path / "real", 1.0), dug(tmp_path / "fast", 10.0)
    assert real > 0.5, f"{real:.3f} m3, {fast:.3f} m3 at ten times the speed"
    assert fast == pytest.approx(real, rel=OFF), f"{fast:.3f} m3 in place of {real:.3f} m3"
