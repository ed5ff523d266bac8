"""Where machines stand, over real topics: a stamped pose, a pose as odometry, and /tf, as their borders say."""

import math
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from geometry_msgs.msg import Pose, PoseStamped, TransformStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage

import programs
from conftest import ports_of, wait_until
from tms_config.clock import monotonic
from tms_config.config import load_site
from tms_config.models import Border
from tms_config.processes import table
from tms_machine.places import Places
from tms_proof.reasons import Old, Unheard
from tms_proof.reasons import Pose as PoseSource
from tms_rc.latch_file import LatchFile
from tms_reason.reason import Reason
from tms_ros.node import Ros
from tms_runtime import environment, metrics
from tms_runtime.reasons import PortSilent

pytestmark = pytest.mark.ros
LIMIT = 40.0  # s for whatever must happen at all
SITE = "{{name: places, domain: 1, backend: {backend}, services: {{}}, machines: {{{machine}: {{model: {model}}}}}}}"
DIGGER, CARRIER, DUMP = "digger_5", "carrier_5", "dump_5"
OLD = 1e9  # s, nothing is older


def pose(x: float, y: float, yaw: float) -> Pose:
    made = Pose()
    made.position.x, made.position.y = x, y
    made.orientation.z, made.orientation.w = math.sin(yaw / 2), math.cos(yaw / 2)
    return made


def odometry(frame: str, at: Pose) -> Odometry:
    message = Odometry()
    message.header.frame_id, message.pose.pose = frame, at
    return message


def stamped(frame: str, at: Pose) -> PoseStamped:
    message = PoseStamped(pose=at)
    message.header.frame_id = frame
    return message


def transform(parent: str, child: str, at: Pose) -> TransformStamped:
    made = TransformStamped(child_frame_id=child)
    made.header.frame_id = parent
    made.transform.translation.x, made.transform.translation.y = at.position.x, at.position.y
    made.transform.rotation = at.orientation
    return made


@pytest.fixture
def borders(tmp_path: Path) -> dict[str, Border]:
    found = {}
    for machine, model, backend in ((DIGGER, "zx200", "physx"), (CARRIER, "mst110cr", "physx"), (DUMP, "ic120", "sim")):
        file = tmp_path / f"{machine}.yaml"
        file.write_text(SITE.format(backend=backend, machine=machine, model=model))
        found[machine] = load_site(str(file)).border(machine)
    return found


class Machines:
    """What three machines tell, and what is made of it."""

    def __init__(self, teller: Ros, listener: Ros, borders: dict[str, Border]) -> None:
        self._ros, self._borders, self._told = teller, borders, dict[str, Any]()
        self.places = Places(listener, borders)

    def tell(self, topic: str, message: Any) -> None:
        if topic not in self._told:
            self._told[topic] = self._ros.publisher(type(message), topic)
        self._told[topic].publish(message)

    def everything(self) -> None:
        """Places, and the odometry of tracks that has turned too little."""
        wrong = odometry(f"{DIGGER}_tf/odom", pose(0.0, 0.0, 0.1))
        for machine, border in self._borders.items():
            self.tell(f"/{machine}/{border.odom}", wrong)
        self.tell(f"/{DIGGER}/base_link/pose", stamped("world", pose(-13.85, -9.17, 0.3)))
        self.tell(f"/{CARRIER}/global_pose", odometry("map", pose(28.53, 36.2, -0.3)))
        frames = [
            transform("map", f"{DUMP}_tf/odom", pose(10.0, 5.0, math.pi / 2)),
            transform(f"{DUMP}_tf/odom", f"{DUMP}_tf/base_link", pose(2.0, 1.0, 0.0)),
        ]
        self.tell("/tf", TFMessage(transforms=frames))

    def known(self) -> dict[str, tuple[float, ...]]:
        self.everything()
        self.places.take()
        seen = {machine: self.places.place(machine) for machine in self._borders}
        return {machine: tuple(place[:3]) for machine, place in seen.items() if place is not None}


@pytest.fixture
def machines(two_nodes: tuple[Ros, Ros], borders: dict[str, Border]) -> Machines:
    return Machines(*two_nodes, borders)


def test_each_machine_is_where_its_own_source_says(machines: Machines) -> None:
    assert machines.places.missing(DUMP, monotonic(), OLD) is None
    silent = {machine: machines.places.missing(machine, monotonic(), OLD) for machine in (DIGGER, CARRIER)}
    assert {reason.args["topic"] for reason in silent.values() if isinstance(reason, Unheard)} == {
        f"/{DIGGER}/base_link/pose", f"/{CARRIER}/global_pose",
    }  # fmt: skip
    wait_until(lambda: len(machines.known()) == 3, LIMIT, "three places")
    known = machines.known()
    assert known[DIGGER] == pytest.approx((-13.85, -9.17, 0.3))
    assert known[CARRIER] == pytest.approx((28.53, 36.2, -0.3))
    assert known[DUMP] == pytest.approx((9.0, 7.0, math.pi / 2))
    assert [machines.places.missing(machine, monotonic(), OLD) for machine in (DIGGER, CARRIER, DUMP)] == [None] * 3


def test_a_machine_that_goes_on_is_seen_there(machines: Machines) -> None:
    wait_until(lambda: len(machines.known()) == 3, LIMIT, "three places")
    before = machines.places.place(DIGGER)
    assert before is not None
    moved = stamped("world", pose(-10.0, -9.17, 0.3))

    def there() -> bool:
        machines.tell(f"/{DIGGER}/base_link/pose", moved)
        machines.places.take()
        place = machines.places.place(DIGGER)
        return place is not None and place.x == -10.0

    wait_until(there, LIMIT, "the new place")
    after = machines.places.place(DIGGER)
    assert after is not None and before.received < after.received <= monotonic()


class Processes:
    """Gateway and planner of a simulated excavator, and what keeps each from its work."""

    def __init__(self, folder: Path, domain: int) -> None:
        file = folder / "site.yaml"
        ports = f"ports: {{metrics: {ports_of(domain)}}}, domain: {domain}"
        file.write_text(
            f"{{name: places, {ports}, backend: physx, services: {{}},"
            f" machines: {{{DIGGER}: {{model: zx200}}, {CARRIER}: {{model: mst110cr}}}}}}"
        )
        site = load_site(str(file))
        LatchFile(site.state, DIGGER).arm()  # as a person has left it
        self._rows = {row.full: row for row in table(site)}
        env = {**os.environ, **environment.environment(site)}
        names = [f"{DIGGER}:rc", f"{DIGGER}:rp"]
        self.running = {name: programs.process(name, env, folder / "log.txt") for name in names}

    def unready(self, name: str) -> Reason | None:
        """What keeps a process from its work, as it says itself."""
        return metrics.unready(self._rows[name])

    def close(self) -> None:
        for process in self.running.values():
            process.terminate()
        for process in self.running.values():
            process.wait(30)


@pytest.fixture
def processes(tmp_path: Path, own_domain: int, monkeypatch: pytest.MonkeyPatch) -> Iterator[Processes]:
    monkeypatch.setenv("ROS_DOMAIN_ID", str(own_domain))
    monkeypatch.setenv("TMS_STATE", str(tmp_path / "state"))
    made = Processes(tmp_path, own_domain)
    yield made
    made.close()


def test_processes_without_the_pose_of_their_machine_are_not_ready_and_name_its_topic(
    processes: Processes, machines: Machines
) -> None:
    joints = JointState(name=["swing_joint", "boom_joint", "arm_joint", "bucket_joint", "bucket_end_joint"])
    joints.position = joints.velocity = [0.0] * 5
    topic = f"/{DIGGER}/base_link/pose"

    def tell(*, posed: bool) -> None:
        machines.tell(f"/{DIGGER}/joint_state", joints)
        machines.tell(f"/{DIGGER}/odom", odometry(f"{DIGGER}_tf/odom", pose(0.0, 0.0, 0.0)))
        if posed:
            machines.tell(topic, stamped("world", pose(1.0, 2.0, 0.0)))

    def lacking(name: str) -> bool:
        tell(posed=False)
        return processes.unready(name) == Unheard(PoseSource(), topic)

    def heard(name: str) -> bool:
        tell(posed=True)
        return not isinstance(processes.unready(name), (Unheard, Old, PortSilent))

    for name in processes.running:
        wait_until(lambda name=name: lacking(name), LIMIT, f"{name} lacks the pose")  # type: ignore[misc]
    for name in processes.running:
        wait_until(lambda name=name: heard(name), LIMIT, f"{name} has it")  # type: ignore[misc]
