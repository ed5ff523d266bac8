"""A gateway holds its machine in the enabled areas: not ready without them, goals refused, a motion stopped in time."""

import json
import math
import os
import random
import signal
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from geometry_msgs.msg import PoseStamped
from nav2_msgs.action import NavigateToPose
from sensor_msgs.msg import JointState
from tms_msg_rc.msg import MachineState, StopReceipt

import area_file
from areas.truth import Rules, edge
from conftest import CLI, GATEWAYS_ONLY, Mesh, mesh_apart, rearm, wait_until
from tms_config.config import load_site
from tms_control.from_above import from_above
from tms_ros.goals import Outcome
from tms_ros.node import Ros

pytestmark = [pytest.mark.turns, pytest.mark.ros, pytest.mark.timeout(600)]
MACHINE = "ic120"
FRONT, REAR = 2.0, 3.6  # m, from its base
HISTORIES = int(os.environ.get("TMS_AREA_HISTORIES", "5"))
HELD_UP = 2  # drives that a busy PC may end
TRIES, DRIVES, DRIVE = 15, 2, 8.0  # goals of a history at most, drives that are enough, s of each
Corners = list[tuple[float, float]]


@dataclass
class Rig:
    """A mesh of one machine, and what its gateway and the truth tell."""

    mesh: Mesh
    ros: Ros
    state: Any = None
    receipts: list[Any] = field(default_factory=list)
    place: tuple[float, float, float] = (0.0, 0.0, 0.0)  # m, m, rad, truly
    rules: Rules | None = None
    broken: tuple[float, float, float] | None = None  # where it was outside

    def __post_init__(self) -> None:
        self._edges = [edge(np.array(one)) for one in from_above(load_site().model_of(MACHINE)).values()]
        self.ros.subscribe(MachineState, f"/{MACHINE}/rc/state", self._told, latched=True)
        self.ros.subscribe(StopReceipt, f"/{MACHINE}/rc/receipts", self.receipts.append, depth=20, latched=True)
        self.ros.subscribe(JointState, f"/{MACHINE}/sim/truth", self._truth, depth=250)

    def _told(self, state: Any) -> None:
        self.state = state

    def _truth(self, message: Any) -> None:
        told = dict(zip(message.name, message.position, strict=True))
        self.place = told["x"], told["y"], told["yaw"]
        rules = self.rules
        if rules is not None and any(rules.broken(one, *self.place) for one in self._edges):
            self.broken = self.place

    def ready(self) -> bool:
        return self.state is not None and self.state.ready

    def stop_with(self, code: str) -> Any:
        return next((one for one in reversed(self.receipts) if code in one.cause), None)

    def seen_from(self, place: tuple[float, float, float], x: float, y: float) -> tuple[float, float]:
        """The place in the map of what is ahead and to the left of another one [m]."""
        c, s = math.cos(place[2]), math.sin(place[2])
        return place[0] + c * x - s * y, place[1] + s * x + c * y

    def enable(self, **areas: tuple[str, Corners]) -> tuple[float, float, float]:
        """Let areas count, whose corners are told from where the machine stands, and arm it; returns that place."""
        self.rules = None
        here = self.place
        there = {
            name: (kind, [self.seen_from(here, *corner) for corner in corners])
            for name, (kind, corners) in areas.items()
        }
        area_file.write(self.mesh, there)
        self.mesh.tms(*area_file.ENABLE)
        wait_until(self.ready, 40, lambda: f"its place is believed: {self.state.reason}")
        wait_until(lambda: rearm(self.ros, MACHINE), 20, "it is armed", every=CLI)
        wait_until(lambda: self.state.armed, 20, "it says so")
        shapes = [(kind, np.array([self.seen_from(here, *one) for one in corners])) for kind, corners in areas.values()]
        self.broken = None
        self.rules = Rules([one for kind, one in shapes if kind == "unmanned"],
                           [one for kind, one in shapes if kind != "unmanned"])  # fmt: skip
        return here

    def go(self, x: float, y: float, yaw: float, seconds: float = 60.0) -> Any:
        """Drive to a place in the map; cancelled after some seconds."""
        goal = NavigateToPose.Goal()
        goal.pose = PoseStamped()
        goal.pose.header.frame_id = "map"
        goal.pose.pose.position.x, goal.pose.pose.position.y = x, y
        goal.pose.pose.orientation.z, goal.pose.pose.orientation.w = math.sin(yaw / 2), math.cos(yaw / 2)
        peer = self.ros.peer(NavigateToPose, f"/{MACHINE}/rc/navigate_to_pose")
        wait_until(peer.ready, 20, "the gateway serves")
        call = peer.send(goal)
        call.wait_for(lambda: call.outcome is not None, seconds)
        if call.outcome is None:
            peer.cancel(call)
        wait_until(lambda: call.outcome is not None, 60, "the goal has ended")
        return call

    def ahead(self, place: tuple[float, float, float], way: float) -> Any:
        """Drive straight ahead from a place."""
        return self.go(*self.seen_from(place, way, 0.0), place[2])

    def gateway_pid(self) -> int:
        rows = json.loads(self.mesh.tms("ps", "--json").stdout)
        return int(next(row["pid"] for row in rows if row["name"] == f"{MACHINE}:rc"))


def box(x0: float, y0: float, x1: float, y1: float) -> Corners:
    return [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]


YARD: tuple[str, Corners] = ("unmanned", box(-20, -20, 40, 20))


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    """One machine, with areas that nobody has enabled yet, of which its gateway has told."""
    changes = {**GATEWAYS_ONLY, "machines": {MACHINE: {"model": "ic120"}}, "sim": {"speed": 1.0}}
    with mesh_apart(tmp_path_factory.mktemp("areas"), **changes) as mesh:
        folder = mesh.site.with_suffix("") / "areas"
        folder.mkdir(parents=True)
        (folder / "yard.geojson").write_text("{}")
        mesh.tms("up", "--no-wait")  # without areas it is not ready
        try:
            ros = Ros("tms_tests_areas")
            made = Rig(mesh, ros)
            wait_until(lambda: made.state is not None and "AREAS_NOT_ENABLED" in made.state.reason, 50, "none enabled")
            wait_until(lambda: made.place != (0.0, 0.0, 0.0), 20, "the truth is told")
            yield made
            ros.close()
        finally:
            mesh.tms("down")


def test_a_machine_is_held_in_its_areas(rig: Rig) -> None:
    here = rig.enable(yard=YARD, hut=("manned", box(12, -4, 14, 6)))
    told = json.loads(rig.mesh.tms("areas", "show", "--json").stdout)
    assert told["gateways"][MACHINE] == {"id": told["configured"], "by": "a person"}
    outside = rig.ahead(here, 39.0)
    assert outside.outcome is Outcome.ABORTED and "LEAVES_AREA" in outside.result.error_msg

    through = rig.ahead(here, 25.0)  # the hut is between
    assert through.outcome is Outcome.ABORTED and "ENTERS_AREA" in through.result.error_msg
    stop = rig.stop_with("ENTERS_AREA")
    assert stop.confirmed and stop.latched and rig.broken is None
    assert 5.0 < math.dist(rig.place[:2], here[:2]) < 12.0 - FRONT

    pid = rig.gateway_pid()
    os.kill(pid, signal.SIGKILL)
    wait_until(lambda: rig.gateway_pid() not in (0, pid), 20, "a new gateway", every=CLI)
    rig.state = None
    wait_until(rig.ready, 40, "the areas are known after its restart, without anybody")
    (state,) = (Path(rig.mesh.state) / "rc").glob("*.areas")
    state.write_text(state.read_text()[:-20])
    os.kill(rig.gateway_pid(), signal.SIGKILL)
    wait_until(lambda: "AREAS_UNREADABLE" in rig.state.reason, 40, "a damaged file is none")


def test_a_machine_that_stands_outside_comes_in_and_only_that(rig: Rig) -> None:
    here = rig.enable(yard=("unmanned", box(1.5 - REAR, -20, 40, 20)))  # its tail is 1.5 m out
    rig.rules = None
    assert "LEAVES_AREA" in rig.ahead(here, 3.0).result.error_msg
    rig.mesh.tms("rearm", MACHINE, "--escape", "--yes", "--by", "a person")
    assert "NOT_FURTHER_IN" in rig.ahead(here, 0.0).result.error_msg
    inside = rig.ahead(here, 3.0)  # at a slow speed, or it would be stopped
    for _ in range(HELD_UP):
        if "AREAS_LATE" in inside.result.error_msg:  # this PC did not look in time
            rig.mesh.tms("rearm", MACHINE, "--escape", "--yes", "--by", "a person")
            inside = rig.ahead(here, 3.0)
    assert inside.outcome is Outcome.SUCCEEDED, inside.result
    wait_until(lambda: not rig.state.moving, 20, "it stands")
    again = rig.mesh.tms("rearm", MACHINE, "--escape", "--yes", "--by", "a person", expect=1)
    assert "it may move as ever" in again.stderr


@pytest.mark.parametrize("seed", range(HISTORIES))
def test_a_random_history_stays_inside(rig: Rig, seed: int) -> None:
    r = random.Random(seed)
    x, y, size = r.uniform(6.5, 9.0), r.uniform(-4.0, 1.0), r.uniform(1.5, 4.0)
    around = [math.tau * i / 9 for i in range(9)]
    ring = [(d * math.cos(turn), d * math.sin(turn)) for turn in around for d in [r.uniform(11.0, 20.0)]]
    kind = r.choice(["manned", "blocked", "restricted"])
    here = rig.enable(yard=("unmanned", ring), closed=(kind, box(x, y, x + size, y + size)))
    drives, answers = 0, []
    for _ in range(TRIES):
        turn, far, before = r.uniform(-0.4, 0.4), r.choice([r.uniform(1.5, 3.0), r.uniform(2.0, 16.0)]), rig.place
        call = rig.go(*rig.seen_from(here, far * math.cos(turn), far * math.sin(turn)), here[2] + turn, DRIVE)
        answers.append((call.outcome, call.result.error_msg))
        assert rig.broken is None, (rig.broken, here, ring, (x, y, size))
        drives += math.dist(before[:2], rig.place[:2]) > 0.5  # or it was refused
        if drives == DRIVES:
            break
        if not rig.state.armed:
            wait_until(lambda: rearm(rig.ros, MACHINE), 20, "it is armed again", every=CLI)
    assert drives > 0, answers
