"""One stand-in machine in an unmanned area with a tracker of people, a gate and hardware, as real processes."""

import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import yaml
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseArray, PoseStamped
from nav2_msgs.action import NavigateToPose
from nav_msgs.msg import Odometry
from std_msgs.msg import String
from tms_msg_rc.msg import MachineState, StopReceipt
from tms_msg_rc.srv import Rearm

import area_file
from conftest import GATEWAYS_ONLY, Mesh, mesh_apart, rearm, wait_until
from tms_machine import stamps
from tms_ros.goals import Outcome
from tms_ros.node import Ros

MACHINE = "ic120"  # it starts at (0, -3.77) and looks along x
AREAS = {
    "yard": ("unmanned", [(-20, -20), (200, -20), (200, 20), (-20, 20)]),
    "fence": ("restricted", [(-20, 20), (200, 20), (200, 30), (-20, 30)]),
}
TRACKERS = {
    "eye": {"kind": "person", "topic": "/eye/people", "silent_after": 2.0},
    "gate": {
        "kind": "gate",
        "topic": "/gate/open",
        "type": "std_msgs/msg/Bool",
        "areas": ["yard"],
        "silent_after": 2.0,
    },
}
HARDWARE = {"emergency_stop": {"topic": "relay"}, "lock_lever": {"topic": "lever"}, "alive": {"topic": "alive"}}
OUTSIDE, NEAR = {"walks": [{"path": [[0, 40]]}]}, {"walks": [{"path": [[0, 25]]}]}
WALK = {"walks": [{"path": [[0, 40], [0, 0]], "speed": 4.0}]}


class Site:
    """What the gateway and the trackers tell, and what happens to them."""

    def __init__(self, mesh: Mesh, ros: Ros) -> None:
        self.mesh, self.ros, self.x = mesh, ros, 0.0
        self.state: Any = None
        self.lamp, self.speed, self.reports = "", 0.0, dict[str, Any]()
        self.receipts: list[Any] = []
        self.people: list[tuple[float, float]] = []  # when, y
        self._trackers = ros.publisher(String, "/sim/trackers")
        self._fault = ros.publisher(String, f"/{MACHINE}/sim/fault")
        ros.subscribe(MachineState, f"/{MACHINE}/rc/state", lambda one: setattr(self, "state", one), latched=True)
        ros.subscribe(StopReceipt, f"/{MACHINE}/rc/receipts", self.receipts.append, depth=20, latched=True)
        ros.subscribe(String, f"/{MACHINE}/sim/lamp", lambda one: setattr(self, "lamp", one.data), latched=True)
        ros.subscribe(DiagnosticArray, f"/{MACHINE}/rc/watches", self._watches, latched=True)
        ros.subscribe(Odometry, f"/{MACHINE}/odom_pose", self._odometry)
        ros.subscribe(PoseArray, "/eye/people", self._saw, depth=10)

    def _saw(self, message: PoseArray) -> None:
        self.people += [(stamps.seconds(message.header.stamp), one.position.y) for one in message.poses]

    def _watches(self, message: DiagnosticArray) -> None:
        self.reports = {one.name: one for one in message.status}

    def _odometry(self, message: Odometry) -> None:
        self.x, self.speed = message.pose.pose.position.x, abs(message.twist.twist.linear.x)

    def be(self, **told: object) -> None:
        self._trackers.publish(String(data=json.dumps(told)))

    def fault(self, **fault: object) -> None:
        self._fault.publish(String(data=json.dumps(fault)))

    def until(self, code: str) -> None:
        """The machine says a reason."""
        wait_until(lambda: self.state is not None and code in self.state.reason, 60, lambda: f"{code}: {self.state}")

    def arm(self) -> None:
        """All is well again, and a person arms the machine."""
        self.be(eye=OUTSIDE, gate={})
        self.fault()
        wait_until(lambda: self.state is not None and self.state.ready, 40, lambda: f"ready: {self.state}")
        if not self.state.armed:
            wait_until(lambda: rearm(self.ros, MACHINE), 30, "armed", every=0.5)

    def drive(self) -> Any:
        """Drive ahead, far enough to be still under way when something happens."""
        self.arm()
        far = 0.0 if self.x > 75.0 else 150.0
        goal = NavigateToPose.Goal(pose=PoseStamped())
        goal.pose.header.frame_id = "map"
        goal.pose.pose.position.x, goal.pose.pose.position.y = far, -3.77
        goal.pose.pose.orientation.w = 1.0
        peer = self.ros.peer(NavigateToPose, f"/{MACHINE}/rc/navigate_to_pose")
        wait_until(peer.ready, 20, "the gateway serves")
        self.receipts.clear()
        call = peer.send(goal)
        wait_until(lambda: self.state.moving or call.outcome is not None, 30, "it moves")
        assert call.outcome is None, call.result
        return call

    def stopped(self, call: Any, code: str, latched: bool = True) -> Any:
        """The receipt of the stop that ended a drive for a reason."""
        wait_until(lambda: call.outcome is not None, 30, "the goal has ended")
        assert call.outcome is Outcome.ABORTED and code in call.result.error_msg, call.result
        wait_until(lambda: any(code in one.cause for one in self.receipts), 20, lambda: f"{code}: {self.receipts}")
        found = next(one for one in self.receipts if code in one.cause)
        assert found.confirmed and found.latched is latched
        return found

    def refused_to_arm(self, code: str) -> bool:
        answer = self.ros.call(Rearm, f"/{MACHINE}/rearm", Rearm.Request(), 8)
        return code in answer.error_msg and not answer.armed


@contextmanager
def people_site(folder: Path, *services: str) -> Iterator[Site]:
    """The site, up, with its areas enabled."""
    changes = {
        **GATEWAYS_ONLY,
        "services": {"host": {}, **{name: {} for name in services}},
        "machines": {MACHINE: {"model": "ic120", "hardware": HARDWARE}},
        "sensing": "sensing.yaml",
        "sim": {"speed": 1.0, "trackers": {"eye": OUTSIDE, "gate": {}}},
    }
    with mesh_apart(folder, **changes) as mesh:
        area_file.write(mesh, AREAS)
        (mesh.site.parent / "sensing.yaml").write_text(yaml.safe_dump({"trackers": TRACKERS}))
        mesh.tms("up", "--no-wait")  # without areas it is not ready
        try:
            ros = Ros("tms_tests_people")
            made = Site(mesh, ros)
            made.until("AREAS_NOT_ENABLED")
            mesh.tms(*area_file.ENABLE)
            yield made
            ros.close()
        finally:
            mesh.tms("down")
