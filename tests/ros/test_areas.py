"""A gateway holds its machine in the enabled areas: not ready without them, goals refused, a motion stopped in time."""

import json
import os
import signal
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from geometry_msgs.msg import PoseStamped
from nav2_msgs.action import NavigateToPose
from tms_msg_rc.msg import MachineState, StopReceipt

from conftest import CLI, GATEWAYS_ONLY, Mesh, mesh_apart, rearm, wait_until
from tms_config.config import load_site
from tms_machine.places import Places
from tms_ros.goals import Outcome
from tms_ros.node import Ros

pytestmark = [pytest.mark.ros, pytest.mark.timeout(300)]
MACHINE = "ic120"
FRONT = 2.0  # m, from its base
AREAS = {  # it starts at (0, -3.77) and looks along x
    "yard": ("unmanned", [(-20, -20), (40, -20), (40, 20), (-20, 20)]),
    "hut": ("manned", [(12, -8), (14, -8), (14, 2), (12, 2)]),
}


def document(areas: dict[str, Any]) -> str:
    features = [
        {
            "type": "Feature",
            "properties": {"id": name, "type": kind},
            "geometry": {"type": "Polygon", "coordinates": [[*corners, corners[0]]]},
        }
        for name, (kind, corners) in areas.items()
    ]
    return json.dumps({"type": "FeatureCollection", "frame": "map", "features": features})


class Seen:
    """What the gateway tells."""

    def __init__(self, ros: Ros) -> None:
        self.state: Any = None
        self.receipts: list[Any] = []
        ros.subscribe(MachineState, f"/{MACHINE}/rc/state", self._state, latched=True)
        ros.subscribe(StopReceipt, f"/{MACHINE}/rc/receipts", self.receipts.append, depth=20, latched=True)

    def _state(self, state: Any) -> None:
        self.state = state

    def ready(self) -> bool:
        return self.state is not None and self.state.ready


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Mesh, Ros, Seen]]:
    """One machine, with areas that nobody has enabled yet."""
    changes = {**GATEWAYS_ONLY, "machines": {MACHINE: {"model": "ic120"}}, "sim": {"speed": 1.0}}
    with mesh_apart(tmp_path_factory.mktemp("areas"), **changes) as mesh:
        folder = mesh.site.with_suffix("") / "areas"
        folder.mkdir(parents=True)
        (folder / "yard.geojson").write_text(document(AREAS))
        mesh.tms("up", expect=None)
        try:
            ros = Ros("tms_tests_areas")
            yield mesh, ros, Seen(ros)
            ros.close()
        finally:
            mesh.tms("down")


def go(ros: Ros, x: float, y: float) -> Any:
    goal = NavigateToPose.Goal()
    goal.pose = PoseStamped()
    goal.pose.header.frame_id = "map"
    goal.pose.pose.position.x, goal.pose.pose.position.y, goal.pose.pose.orientation.w = x, y, 1.0
    peer = ros.peer(NavigateToPose, f"/{MACHINE}/rc/navigate_to_pose")
    wait_until(peer.ready, 20, "the gateway serves")
    call = peer.send(goal)
    wait_until(lambda: call.outcome is not None, 60, "the goal has ended")
    return call


def gateway_pid(mesh: Mesh) -> int:
    rows = json.loads(mesh.tms("ps", "--json").stdout)
    return int(next(row["pid"] for row in rows if row["name"] == f"{MACHINE}:rc"))


def test_a_machine_and_its_areas(site: tuple[Mesh, Ros, Seen]) -> None:
    mesh, ros, seen = site
    wait_until(lambda: seen.state is not None and seen.state.reason, 30, "it says why it is not ready")
    wait_until(lambda: "AREAS_NOT_ENABLED" in seen.state.reason, 20, "no areas are enabled")
    mesh.tms("areas", "enable", "--yes", "--by", "a person")
    told = json.loads(mesh.tms("areas", "show", "--json").stdout)
    assert told["gateways"][MACHINE] == {"id": told["configured"], "by": "a person"}
    wait_until(seen.ready, 30, lambda: f"its place is believed: {seen.state.reason}")
    rearm(ros, MACHINE)

    places = Places(ros, {MACHINE: load_site().border(MACHINE)})
    outside = go(ros, 39.0, -3.77)
    assert outside.outcome is Outcome.ABORTED and "LEAVES_AREA" in outside.result.error_msg

    through = go(ros, 25.0, -3.77)  # the hut is between
    assert through.outcome is Outcome.ABORTED and "ENTERS_AREA" in through.result.error_msg
    stop = next(one for one in seen.receipts if "ENTERS_AREA" in one.cause)
    assert stop.confirmed and stop.latched
    places.take()
    place = places.place(MACHINE)
    assert place is not None and 5.0 < place.x < 12.0 - FRONT

    # its tail stands outside of other areas: it may come in, and only that
    file = mesh.site.with_suffix("") / "areas" / "yard.geojson"
    file.write_text(document({"yard": ("unmanned", [(place.x, -20), (40, -20), (40, 20), (place.x, 20)])}))
    mesh.tms("areas", "enable", "--yes", "--by", "a person")
    rearm(ros, MACHINE)
    assert "LEAVES_AREA" in go(ros, place.x + 4.0, -3.77).result.error_msg
    mesh.tms("rearm", MACHINE, "--escape", "--yes", "--by", "a person")
    assert "NOT_FURTHER_IN" in go(ros, place.x, -3.77).result.error_msg
    inside = go(ros, place.x + 4.0, -3.77)  # at a slow speed, or it were stopped
    assert inside.outcome is Outcome.SUCCEEDED, inside.result
    wait_until(lambda: mesh.tms("rearm", MACHINE, "--escape", expect=None).returncode == 1, 20, "it is over", every=CLI)

    pid = gateway_pid(mesh)
    os.kill(pid, signal.SIGKILL)
    wait_until(lambda: gateway_pid(mesh) not in (0, pid), 20, "a new gateway", every=CLI)
    seen.state = None
    wait_until(seen.ready, 40, "the areas are known after its restart, without anybody")
    (state,) = (Path(mesh.state) / "rc").glob("*.areas")
    state.write_text(state.read_text()[:-20])
    os.kill(gateway_pid(mesh), signal.SIGKILL)
    wait_until(lambda: "AREAS_UNREADABLE" in seen.state.reason, 40, "a damaged file is none")
