"""Process `<machine>:rc`: the machine's gateway. Its stops need no database, no scheduler and no console."""

import threading
from collections.abc import Callable

from prometheus_client import Gauge
from std_msgs.msg import Bool
from tms_msg_rc.msg import MachineState
from tms_msg_rc.srv import Rearm, StopMachine, TakeMachine

from tms_config.clock import monotonic
from tms_machine.border import Controls, motions
from tms_machine.permit import LEASE, Permit
from tms_rc.arming import Arming
from tms_rc.claim import Claim
from tms_rc.gateway import Gateway, speed_of
from tms_rc.guard import FRESH, Guard
from tms_rc.latch import Latch
from tms_rc.latch_file import LatchFile
from tms_rc.machine_monitor import MachineMonitor
from tms_rc.notes import Notes
from tms_rc.presses import Presses
from tms_rc.reasons import ControllerAway, LooksForRivals, Recovering
from tms_rc.recovery import Recovery
from tms_rc.standstill import StandStill
from tms_reason.reason import Reason
from tms_reason.wire import to_line
from tms_ros.client import AnyPeer
from tms_runtime.app import App

MOVING_PERIOD, STILL_PERIOD = 0.2, 0.5  # s between messages about the machine; a change is reported at once
SIGNALS = 100  # messages of all stop buttons that may wait: no `false` of one may push out the `true` of another
PERMIT = Gauge("tms_rc_permit", "1 while a run stands behind the machine's motions")
LATCHED = Gauge("tms_rc_latched", "1 while the machine is stopped until a person re-arms it")
HELD = Gauge("tms_rc_held", "1 while only the run that lost a process may move the machine")
TAKEN = Gauge("tms_rc_taken", "1 while a person drives the machine by hand")
MOVING = Gauge("tms_rc_moving", "1 while the machine is seen to move")
STATE_AGE = Gauge("tms_rc_machine_news_age_seconds", "Age of the oldest of joint states and odometry")
NEVER = 1e9  # s
GATEWAY = bytes([255]) * 16  # the goal in the gateway's own permit: it stands behind the machine itself


def start(app: App) -> None:
    """Serve motion, stop and re-arm of one machine and publish its state, unless another gateway does."""
    threading.Thread(target=_begin, args=(app, Claim(app)), name="claim", daemon=True).start()


def _begin(app: App, claim: Claim) -> None:
    over = False
    try:
        _serve(app, claim)
        over = True
    finally:
        if not over and not app.ros.closing:  # a bug: half a gateway must not stay
            app.ros.failed.set()


def _serve(app: App, claim: Claim) -> None:
    app.ready_when(lambda: claim.rival or LooksForRivals())
    if not claim.serve():
        return
    border, machine = app.site.border(app.machine), app.machine
    watch = StandStill(app.site.model_of(machine), border, speed_of(app))
    memory = LatchFile(app.site.state, machine)
    left = memory.read()
    latch = Latch(machine, left.latched)
    view = MachineMonitor(app, watch)
    guard = Guard(app, watch, Controls(app.ros, machine, border), latch, Notes(app, memory, latch))
    recovery = Recovery(app, guard, left)
    reported = StateTopic(app, guard, view, claim)
    _offer(app, guard, Gateway(app, guard, watch), reported)
    publisher = app.ros.publisher(MachineState, f"/{machine}/rc/state", depth=1, latched=True)
    state_publisher = StatePublisher(guard, watch, lambda: publisher.publish(reported.state()))
    guard.reported = state_publisher.publish_now
    for step in (view.take_samples, guard.check, state_publisher.check):
        app.pulse.add(step)
    permit = Permit(app.ros, app.pulse, machine, "rc")
    # Wait until the lease of a killed predecessor has run out: before, its loss would go unnoticed.
    app.ros.on_executor(lambda: app.ros.after(LEASE, lambda: permit.hold(GATEWAY)))
    app.ready_when(reported.unready)
    recovery.run()


def _offer(app: App, guard: Guard, gateway: Gateway, reported: "StateTopic") -> None:
    border, machine, ros, arming = app.site.border(app.machine), app.machine, app.ros, Arming(app, guard)
    for motion in motions(border):
        peer = ros.peer(motion.type, f"/{machine}/{getattr(border, motion.field)}")
        reported.peers.append(peer)
        gateway.serve(motion, peer)
    ros.subscribe(Bool, "/emergency_signal", guard.signal, depth=SIGNALS)
    if border.emg_stop:
        Presses(app, guard, f"/{machine}/{border.emg_stop}")
    if border.manual:
        ros.subscribe(Bool, f"/{machine}/{border.manual}", arming.manual, depth=SIGNALS)
    ros.offer_slow(StopMachine, f"/{machine}/rc/stop", guard.stop_service)
    ros.offer_slow(StopMachine, "/tms/stop", guard.stop_service)  # all gateways get it, the first one answers
    ros.offer_slow(Rearm, f"/{machine}/rearm", arming.rearm)
    ros.offer_slow(TakeMachine, f"/{machine}/take", arming.take)


class StatePublisher:
    """Publishes the state by the pulse: a timer, and a callback of every reader, would cost more than the message."""

    def __init__(self, guard: Guard, watch: StandStill, publish: Callable[[], None]) -> None:
        self._guard, self._watch, self._publish = guard, watch, publish
        self._last: tuple[object, ...] = ()
        self._at = 0.0  # monotonic

    def check(self) -> None:
        """Publish at a beat if the state has changed or the period is over."""
        guard, moving = self._guard, self._watch.moving()
        active, latch = guard.active, guard.latch
        now = (moving, active and active.goal.id, latch.cause, latch.hold, guard.permits.holder(), guard.by_hand)
        period = MOVING_PERIOD if moving or active is not None else STILL_PERIOD
        if now != self._last or monotonic() - self._at >= period:
            self._last = now
            self.publish_now()

    def publish_now(self) -> None:
        """Publish the state; from any thread."""
        self._at = monotonic()
        self._publish()


class StateTopic:
    """The state of the machine as the gateway publishes it."""

    def __init__(self, app: App, guard: Guard, view: MachineMonitor, claim: Claim) -> None:
        self._app, self._guard, self._view, self._claim = app, guard, view, claim
        self.peers: list[AnyPeer] = []

    def unready(self) -> Reason | None:
        """Why the machine cannot be moved now, apart from a stop."""
        if self._claim.rival or self._guard.recovering:
            return self._claim.rival or Recovering()
        now, watch = monotonic(), self._guard.watch
        silent, trouble = watch.silent(now, FRESH), watch.trouble(now)
        if silent is not None:
            return self._view.strange_type() or silent
        if trouble is not None:
            return trouble.reason
        machine = self._app.machine
        return next((ControllerAway(machine, peer.name) for peer in self.peers if not peer.ready()), None)

    def state(self) -> MachineState:
        """The message to publish."""
        guard, now, reason = self._guard, monotonic(), self.unready()
        active, watch, latch = guard.active, guard.watch, guard.latch
        positions, velocities = watch.positions, watch.velocities
        moving, holder, age = watch.moving(), guard.permits.holder(), min(watch.age(now), NEVER)
        PERMIT.set(bool(holder))
        LATCHED.set(latch.cause is not None)
        HELD.set(latch.hold is not None)
        TAKEN.set(bool(guard.by_hand))
        MOVING.set(moving)
        STATE_AGE.set(age)
        return MachineState(
            machine=self._app.machine, ready=reason is None, moving=moving,
            goal=active.goal.id if active else "", owner=holder,
            joint_names=list(positions), positions=list(positions.values()),
            velocities=[velocities.get(name, 0.0) for name in positions],
            age=age, reason=to_line(reason), by_hand=guard.by_hand,
            armed=not latch.cause and not latch.hold, latch=to_line(latch.cause), hold=to_line(latch.hold),
        )  # fmt: skip
