"""Records one machine: its true motion, orders and goals at its own servers, and the messages of its gateway."""

import threading
from collections.abc import Callable

from action_msgs.msg import GoalStatusArray
from geometry_msgs.msg import Twist
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool
from tms_msg_rc.msg import MachineState, StopReceipt

from tms_cli.drill.operasim import OperaSim
from tms_cli.drill.record import Goal, MotionSample, Receipt, ReportedState, TrialRecording, sample_of, time_of
from tms_config.clock import monotonic, sleep, unix_time
from tms_config.config import Site
from tms_config.models import Still
from tms_machine.border import motions
from tms_ros.node import Ros
from tms_runtime.pulse import Pulse

CANCELING, SUCCEEDED, CANCELED, ABORTED = 3, 4, 5, 6  # action_msgs/GoalStatus
KEPT = 120.0  # s, longer than any trial
ROUND = 10.0  # s between deletions of old entries
CHECK_PERIOD = 0.1  # s
WAITING = 250  # samples of the truth, ten seconds


class StopObserver:
    """Callbacks run on the executor thread, samples in the thread of the pulse, all else in threads of the trials."""

    def __init__(self, node: Ros, site: Site, machine: str, operasim: OperaSim | None) -> None:
        border, still = site.border(machine), site.model_of(machine).still
        self._lock = threading.Lock()
        self._record = TrialRecording()
        self._forgotten = unix_time()
        self._truth = operasim.truth(machine, still) if operasim is not None else told_truth(node, machine, still)
        Pulse(node).add(self._take_truth)
        node.subscribe(StopReceipt, f"/{machine}/rc/receipts", self._on_receipt, depth=20, latched=True)
        node.subscribe(MachineState, f"/{machine}/rc/state", self._on_state, depth=10, latched=True)
        for motion in motions(border):
            topic = f"/{machine}/{getattr(border, motion.field)}/_action/status"
            node.subscribe(GoalStatusArray, topic, self._on_status, depth=10, latched=True)
        if border.cmd_vel and border.controller == "theirs":  # ours sends its zeros when it does nothing
            node.subscribe(Twist, f"/{machine}/{border.cmd_vel}", self._on_velocity, depth=10)
        if border.emg_stop:
            node.subscribe(Bool, f"/{machine}/{border.emg_stop}", self._on_emergency, depth=10)

    def _take_truth(self) -> None:
        samples = self._truth()
        with self._lock:
            self._record.truth += samples
            if samples and samples[-1].at - self._forgotten > ROUND:
                self._forgotten = samples[-1].at
                self._record = self._record.since(self._forgotten - KEPT)

    def _on_receipt(self, message: StopReceipt) -> None:
        now = unix_time()
        receipt = Receipt(
            time_of(message.stamp), message.seconds, message.confirmed, message.cause, message.detail, now
        )
        with self._lock:
            same = any(one.begun == receipt.begun for one in self._record.receipts)  # published again after a restart
            if not same and receipt.at > now - KEPT:
                self._record.receipts.append(receipt)

    def _on_state(self, message: MachineState) -> None:
        with self._lock:
            self._record.states.append(ReportedState(unix_time(), message.latch, message.hold))

    def _on_velocity(self, message: Twist) -> None:
        if message.linear.x == 0.0 and message.angular.z == 0.0:
            self._commanded()

    def _on_emergency(self, message: Bool) -> None:
        if message.data:
            self._commanded()
            return
        with self._lock:
            self._record.releases.append(unix_time())

    def _commanded(self) -> None:
        with self._lock:
            self._record.commands.append(unix_time())

    def _on_status(self, message: GoalStatusArray) -> None:
        now = unix_time()
        with self._lock:
            for one in message.status_list:
                key, began = bytes(one.goal_info.goal_id.uuid), time_of(one.goal_info.stamp)
                if began < now - KEPT:
                    continue
                goal = self._record.goals.setdefault(key, Goal(began))
                if goal.ended is None and one.status in (CANCELING, CANCELED):
                    self._record.commands.append(now)
                if goal.ended is None and one.status in (SUCCEEDED, CANCELED, ABORTED):
                    goal.ended, goal.arrived = now, one.status == SUCCEEDED

    def since(self, at: float) -> TrialRecording:
        """A copy of the record since a moment (s since 1970)."""
        with self._lock:
            return self._record.since(at)

    def wait(self, holds: Callable[[TrialRecording], bool], since: float, seconds: float) -> bool:
        """Wait until the record since a moment satisfies `holds`; False after `seconds`."""
        deadline = monotonic() + seconds
        while not holds(self.since(since)):
            if monotonic() > deadline:
                return False
            sleep(CHECK_PERIOD)
        return True

    def forget_open_goals(self) -> None:
        """Take goals for ended that a run before has left open: their server was killed and cannot tell."""
        with self._lock:
            self._record.close_goals(unix_time())

    def open_since(self) -> float | None:
        """The begin of the open goal; None without one."""
        with self._lock:
            return max((one.began for one in self._record.goals.values() if one.ended is None), default=None)


def told_truth(node: Ros, machine: str, still: Still) -> Callable[[], list[MotionSample]]:
    """A function that takes what a stand-in has told since its last call.

    Sampled without callbacks: 150 callbacks a second would take a tenth of a busy PC's processor.
    """
    arrivals = node.sample_arrivals(JointState, f"/{machine}/sim/truth", WAITING, best_effort=False)
    return lambda: [sample_of(arrival.message, still) for arrival in arrivals()]
