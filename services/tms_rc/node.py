"""Process `<machine>:rc`: the machine's gateway. It depends on no database, no scheduler and no console to stop."""

import math
import threading
import time
from collections.abc import Callable, Sequence
from typing import Any

from nav_msgs.msg import Odometry
from prometheus_client import Gauge
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool
from tms_msg_rc.msg import MachineState
from tms_msg_rc.srv import Rearm, StopMachine

from tms_core.app import App
from tms_core.border import Controls, motions
from tms_core.permit import LEASE, Permit
from tms_core.ros import Peer
from tms_rc.gateway import Gateway
from tms_rc.guard import Guard
from tms_rc.standstill import JOINTS, ODOM, StandStill

TOLD_MOVING, TOLD_STILL = 0.2, 0.5  # s between messages about the machine; a change is told at once
DEPTH = 10  # messages of the machine that may come between two looks
SIGNALS = 100  # of all buttons that may wait: no `false` may push out the `true` of another one
PERMIT = Gauge("tms_rc_permit", "1 while a run stands behind the machine's motions")
LATCHED = Gauge("tms_rc_latched", "1 while the machine is stopped until a person re-arms it")
HELD = Gauge("tms_rc_held", "1 while only the run that lost a process may move the machine")
MOVING = Gauge("tms_rc_moving", "1 while the machine is seen to move")
NEWS_AGE = Gauge("tms_rc_machine_news_age_seconds", "Age of the oldest of joint states and odometry")
NEVER = 1e9  # s
GATEWAY = bytes([255]) * 16  # what the gateway's own permit stands behind: the machine itself


def start(app: App) -> None:
    """Offer guarded motion, stop and re-arm of one machine, and tell its state."""
    border, machine, ros = app.site.border(app.machine), app.machine, app.ros
    sources = [name for name, topic in ((JOINTS, border.joint_states), (ODOM, border.odom)) if topic]
    watch = StandStill(app.site.model_of(machine).still, sources)
    view = View(app, watch)
    guard = Guard(app, watch, Controls(ros, machine, border))
    gateway = Gateway(app, guard, watch)
    for motion in motions(border):
        peer = ros.peer(motion.type, f"/{machine}/{getattr(border, motion.field)}")
        view.peers.append(peer)
        gateway.serve(motion, peer)
    ros.subscribe(Bool, "/emergency_signal", guard.signal, depth=SIGNALS)
    ros.offer_slow(StopMachine, f"/{machine}/rc/stop", guard.stop_service)
    ros.offer_slow(StopMachine, "/tms/stop", guard.stop_service)  # every gateway hears it; the first one answers
    ros.offer(Rearm, f"/{machine}/rearm", guard.rearm)
    publisher = ros.publisher(MachineState, f"/{machine}/rc/state", depth=1, latched=True)
    teller = Teller(guard, watch, lambda: publisher.publish(view.state(guard)))
    guard.told = teller.tell
    ros.pulse.add(view.look)
    ros.pulse.add(teller.look)
    permit = Permit(ros, machine, "rc")
    # Not before the lease of a predecessor that was killed has run out: nobody would notice its loss.
    ros.after(LEASE, lambda: permit.hold(GATEWAY))
    threading.Thread(target=guard.recover, name="recover", daemon=True).start()
    app.ready_when(view.unready)


class Teller:
    """When the state is published: by the pulse, since a timer and every reader's callback cost more than the news."""

    def __init__(self, guard: Guard, watch: StandStill, publish: Callable[[], None]) -> None:
        self._guard, self._watch, self._publish = guard, watch, publish
        self._last: tuple[object, ...] = ()
        self._at = 0.0  # monotonic

    def look(self) -> None:
        """At every beat."""
        guard, moving = self._guard, self._watch.moving()
        active, latch = guard.active, guard.latch
        now = (moving, active and active.goal.id, latch.cause, latch.hold, guard.permits.holder())
        period = TOLD_MOVING if moving or active is not None else TOLD_STILL
        if now != self._last or time.monotonic() - self._at >= period:
            self._last = now
            self.tell()

    def tell(self) -> None:
        """From any thread."""
        self._at = time.monotonic()
        self._publish()


class View:
    """What is heard of the machine."""

    def __init__(self, app: App, watch: StandStill) -> None:
        self._app, self._watch = app, watch
        renamed = app.site.border(app.machine).joints
        # name on the wire -> name in the model
        self._names = {renamed.get(name, name): name for name in app.site.model_of(app.machine).joints}
        self.peers: list[Peer] = []
        border = app.site.border(app.machine)
        topics = ((JointState, border.joint_states, self._joints_heard), (Odometry, border.odom, self._odometry_heard))
        self._news = [
            (app.ros.sample(kind, f"/{app.machine}/{topic}", DEPTH), heard) for kind, topic, heard in topics if topic
        ]

    def look(self) -> None:
        """Take what the machine has told since the last look: at every beat, so that no callback delays it."""
        for news, heard in self._news:
            if messages := news():
                heard(messages)

    def _joints_heard(self, messages: list[Any]) -> None:
        """Joint states are matched by name: backends order them differently, and may send some joints at a time."""
        positions: dict[str, float] = {}
        velocities: dict[str, float] = {}
        for message in messages:
            known = [(i, self._names[name]) for i, name in enumerate(message.name) if name in self._names]
            positions |= _numbers(known, message.position)
            velocities |= _numbers(known, message.velocity)
        self._watch.update(time.monotonic(), positions, velocities)

    def _odometry_heard(self, messages: list[Any]) -> None:
        """Place and speeds of the machine."""
        at, speed = messages[-1].pose.pose.position, messages[-1].twist.twist
        linear = math.hypot(speed.linear.x, speed.linear.y)
        self._watch.update_odometry(time.monotonic(), (at.x, at.y), linear, speed.angular.z)

    def unready(self) -> str | None:
        """Why the machine cannot be moved now, apart from a stop."""
        silent = self._watch.silent(time.monotonic(), 1.0)
        return silent or next((f"{peer.name} is not there" for peer in self.peers if not peer.ready()), None)

    def state(self, guard: Guard) -> MachineState:
        """What is published."""
        now, reason, active = time.monotonic(), self.unready(), guard.active
        positions, velocities = self._watch.positions, self._watch.velocities
        latch, hold = guard.latch.cause, guard.latch.hold
        moving, holder, age = self._watch.moving(), guard.permits.holder(), min(self._watch.age(now), NEVER)
        PERMIT.set(bool(holder))
        LATCHED.set(bool(latch))
        HELD.set(bool(hold))
        MOVING.set(moving)
        NEWS_AGE.set(age)
        return MachineState(
            machine=self._app.machine, ready=reason is None, moving=moving,
            goal=active.goal.id if active else "", owner=holder,
            joint_names=list(positions), positions=list(positions.values()),
            velocities=[velocities.get(name, 0.0) for name in positions],
            age=age, reason=reason or "",
            armed=not latch and not hold, latch=latch, hold=hold,
        )  # fmt: skip


def _numbers(known: list[tuple[int, str]], values: Sequence[float]) -> dict[str, float]:
    """By joint; what is not there or not a number was not heard."""
    return {name: values[i] for i, name in known if i < len(values) and math.isfinite(values[i])}
