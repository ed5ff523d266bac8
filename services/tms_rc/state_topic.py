"""The state of a machine, as its gateway publishes it."""

from prometheus_client import Gauge
from tms_msg_rc.msg import MachineState

from tms_decision.gateway.effects import Publish
from tms_decision.gateway.state import Gateway
from tms_decision.reasons import ControllerAway, Recovering
from tms_rc.claim import Claim
from tms_rc.lamp import Lamp
from tms_rc.machine_monitor import MachineMonitor
from tms_rc.motion_servers import MotionServers
from tms_rc.shell import Shell
from tms_reason.reason import Foreign, Reason
from tms_reason.wire import to_line
from tms_runtime.app import App

PERMIT = Gauge("tms_rc_permit", "1 while a run stands behind the machine's motions")
LATCHED = Gauge("tms_rc_latched", "1 while the machine is stopped until a person re-arms it")
HELD = Gauge("tms_rc_held", "1 while only the run that lost a process may move the machine")
TAKEN = Gauge("tms_rc_taken", "1 while a person drives the machine by hand")
MOVING = Gauge("tms_rc_moving", "1 while the machine is seen to move")
STATE_AGE = Gauge("tms_rc_machine_news_age_seconds", "Age of the oldest of joint states and odometry")
NEVER = 1e9  # s


class StateTopic:
    """Publishes the state when the decisions say so."""

    def __init__(self, app: App, shell: Shell, monitor: MachineMonitor, servers: MotionServers, claim: Claim) -> None:
        self._app, self._shell, self._monitor, self._servers, self._claim = app, shell, monitor, servers, claim
        publisher = app.ros.publisher(MachineState, f"/{app.machine}/rc/state", depth=1, latched=True)
        lamp = Lamp(app)

        def publish() -> None:
            state = shell.read(self._state)
            publisher.publish(state)
            lamp.show(state)

        shell.does(Publish, lambda _: publish())

    def unready(self) -> Reason | None:
        """Why the machine cannot be moved now, apart from a stop."""
        return self._shell.read(self._unready)

    def _unready(self, gateway: Gateway, now: float) -> Reason | None:
        if self._claim.rival or gateway.recovering:
            return self._claim.rival or Recovering()
        silent, trouble = gateway.silent(now), gateway.watch.trouble(now)
        if silent is not None:
            return self._monitor.strange_type() or silent
        if trouble is not None:
            return trouble.reason
        areas, machine = self._servers.areas, self._app.machine
        if areas is not None and (unwatched := areas.unready()) is not None:
            return unwatched
        if (forbidden := self._servers.forbidden()) is not None:
            return forbidden
        return next((ControllerAway(machine, peer.name) for peer in self._servers.peers if not peer.ready()), None)

    def _state(self, gateway: Gateway, now: float) -> MachineState:
        reason, watch, latch = self._unready(gateway, now), gateway.watch, gateway.latch
        positions, velocities = watch.positions, watch.velocities
        moving, holder, age = watch.moving(), gateway.holder(now), min(watch.age(now), NEVER)
        PERMIT.set(bool(holder))
        LATCHED.set(latch.cause is not None)
        HELD.set(latch.hold is not None)
        TAKEN.set(gateway.by_hand is not None)
        MOVING.set(moving)
        STATE_AGE.set(age)
        driver = gateway.by_hand
        return MachineState(
            machine=self._app.machine, ready=reason is None, moving=moving,
            goal=gateway.active.asked.id if gateway.active is not None else "", owner=holder,
            joint_names=list(positions), positions=list(positions.values()),
            velocities=[velocities.get(name, 0.0) for name in positions],
            age=age, reason=to_line(reason), by_hand=driver.words if isinstance(driver, Foreign) else to_line(driver),
            armed=latch.cause is None and latch.hold is None, latch=to_line(latch.cause), hold=to_line(latch.hold),
        )  # fmt: skip
