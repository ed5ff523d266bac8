"""A mesh with one stand-in machine, whose fault points are those of the drill, and a client that sees it."""

import json
import os
import signal
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import AbstractContextManager, closing, suppress
from dataclasses import dataclass
from typing import Any

from std_msgs.msg import Bool, String
from test_several_losses import armed
from tms_msg_db.srv import AddTask

from conftest import Mesh, wait_until
from replay import acts as a
from replay.plans import ONE
from tms_cli import session, stored_records
from tms_cli.drill.stop_observer import StopObserver
from tms_config.clock import unix_time
from tms_config.config import Site
from tms_host.supervisor import Supervisor
from tms_ros.node import Ros

LIMIT = 60.0  # s for whatever must happen at all
SUBTASK = "subtask_zx200_change_pose"
SWINGS = {
    "left": 2.5,
    "right": 0.5,
}  # rad, long enough for a busy PC, from where the machine stands at the begin
FAULTS: Mapping[a.Fault, Mapping[str, Any]] = {
    a.Fault.COASTS: {"coast": 2.0},
    a.Fault.IGNORES_STOPS: {"ignore_cancel": True, "ignore_emg_stop": True},
    a.Fault.FROZEN_STAMPS: {"frozen_stamp": True},
}


@dataclass
class RealSite:
    """Everything."""

    mesh: Mesh
    site: Site
    ros: Ros
    stalled: Callable[[], AbstractContextManager[None]]  # inside, nothing gets onto the disk

    def __post_init__(self) -> None:
        self.observer = StopObserver(self.ros, self.site, ONE, None)
        self.button = self.ros.publisher(Bool, "/emergency_signal")
        self._fault = self.ros.publisher(String, f"/{ONE}/sim/fault")

    def be(self, fault: a.Fault | None) -> None:
        """The machine gets a fault, or is in order again."""
        silent = {"mute": list(self.site.model_of(ONE).joints)}
        data = {} if fault is None else silent if fault is a.Fault.SILENT else FAULTS[fault]
        self._fault.publish(String(data=json.dumps(data)))

    def put_in_order(self) -> None:
        """Everything works, nothing runs, and the machine is armed, whatever the last plan has left."""
        self.be(None)
        self.mesh.wait_ready()
        wait_until(lambda: armed(self.mesh), LIMIT, f"{ONE} can be re-armed", 0.5)
        self.mesh.wait_ready()

    def write_records(self) -> None:
        """Poses to which the machine swings from where it is now, to and fro about its middle."""
        since = unix_time()
        wait_until(lambda: self.observer.since(since).truth, LIMIT, f"{ONE} tells how it truly moves")
        at = self.observer.since(since).truth[-1].joints
        joints = {joint: at[joint] for joint in self.site.model_of(ONE).joints}
        side = -1.0 if joints["swing_joint"] > 0.0 else 1.0
        for name, way in SWINGS.items():
            values = {**joints, "swing_joint": joints["swing_joint"] + side * way, "trajectory": 1}
            stored_records.write(self.ros, (ONE, name), values, create=True, type="static", description="replay")

    def task(self, leaves: Iterable[str]) -> int:
        """The stored task with these leaves."""
        words = "".join(
            f'<Action ID="LeafNodeZx200" model_name="{ONE}" subtask_name="{SUBTASK}" record_name="{name}"/>'
            for name in leaves
        )
        tree = f'<root main_tree_to_execute="T"><BehaviorTree ID="T"><Sequence>{words}</Sequence></BehaviorTree></root>'
        stored = session.call(self.ros, AddTask, "/tms/db/add_task", task_sequence=tree, description="replay")
        return int(stored.task_id)

    def pids(self, processes: Iterable[str]) -> list[int]:
        """Of processes as plans name them."""
        with closing(Supervisor(self.site)) as supervisor:
            found = {row.name: row.pid for row in supervisor.processes()}
        return [found[full_name(process)] for process in processes]


def full_name(process: str) -> str:
    """A process as `tms ps` names it."""
    if process in (a.SCHEDULER, a.HOST):
        return f"tms:{process}"
    return f"{ONE}:{SUBTASK if process == a.SUBTASK else process}"


def send_signal(number: signal.Signals, pids: Sequence[int]) -> None:
    """Send a signal to the processes that have not ended."""
    for pid in pids:
        with suppress(ProcessLookupError):  # it was replaced meanwhile
            os.kill(pid, number)
