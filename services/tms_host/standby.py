"""Stops a machine in place of its gateway, if that was killed, is frozen, or has a thread that hangs.

The sign of a working gateway is its pulse, the lease of its permit, not its process. When the pulse is lost:

- at once, and every 0.5 s until a gateway is back: cancel the goals of all clients, zero velocities;
- `emg_stop`, where the machine has one: at once when the scheduler behind the machine's run is lost as well, since the
  machine is latched then anyway; else after 1 s more, if the machine was last reported to move, or has a goal or run.
    Most gateways are back before that. An idle machine that stands only gets cancel and zero: a person may be at its
    levers, and a crash of software that does not move the machine must not take it from that person;
  - a gateway that ends in order (`tms restart`, `tms down`) has stopped the machine: cancel and zero again, no alarm.
    For some seconds after another loss this cannot be told from a loss, and counts as one.

  A press of the stop button that a gateway did not live to remember is handed on to its successor as a request; it is
  noted on the disk, too, should this process not live to do that.

  Only a gateway releases `emg_stop`. The commands leave from the pulse's thread, before they are logged and counted.
"""

from builtin_interfaces.msg import Time
from prometheus_client import Counter, Gauge
from std_msgs.msg import Bool
from tms_msg_rc.msg import MachineState
from tms_msg_rc.srv import StopMachine

from tms_config.clock import monotonic
from tms_config.processes import here
from tms_decision.duty import Act, Duty, GatewayStatus, Press
from tms_decision.permit_link import NOBODY
from tms_decision.reasons import SoftwareStop
from tms_host.pressed_notes import PressedNotes
from tms_machine.border import Controls, standby, stood_in
from tms_machine.permit import RemotePermit
from tms_reason.wire import to_line
from tms_runtime.app import App

TOGETHER = 1.0  # s between the losses of scheduler and gateway within which they count as one
GATEWAY = "tms_rc.node"
SIGNALS = 100  # messages of all stop buttons that may wait: no `false` of one may push out the `true` of another

STOOD_IN = Counter("tms_host_stood_in", "Times that a machine was stopped in place of its lost gateway", ["machine"])
LOST = Gauge("tms_host_gateway_lost", "1 while a machine's gateway gives no pulse", ["machine"])


class StandbyGateway:
    """The standby of one machine's gateway; all that a stop needs is prepared."""

    def __init__(self, app: App, machine: str) -> None:
        ros = app.ros
        self.machine, self.duty = machine, Duty()
        self._log = app.log
        self._done: Act | None = None  # the command since the gateway was lost, as it was logged
        self._controls = Controls(ros, machine, app.site.border(machine), keeps_emergency=False)
        self._ros, self._press = ros, Press()
        ros.prepare(StopMachine, f"/{machine}/rc/stop")
        self._now, self._stood_in = ros.now, ros.publisher(Time, stood_in(machine), 1, latched=True)
        self._acts = ros.publisher(Bool, standby(machine), 1, latched=True)
        self._acts.publish(Bool(data=False))
        self._gateway = RemotePermit(ros, app.pulse, machine, "rc", _looked_at)
        self._scheduler = RemotePermit(ros, app.pulse, machine, "ts", _looked_at)
        self._samples = ros.sample(MachineState, f"/{machine}/rc/state")
        self._state: MachineState | None = None  # the last one of a lost gateway
        self._held_at = float("-inf")  # when a run last held the machine
        LOST.labels(machine).set(0)
        STOOD_IN.labels(machine)

    def check(self, now: float) -> None:
        """Command what is due, at every beat of the pulse."""
        lost, press = self.duty.lost_since is not None, self._press
        reported = self._samples() if lost or press.since is not None or not self._gateway.alive else []
        if press.due(now, self._gateway.alone, bool(reported[-1].latch) if reported else None):
            self._ros.on_executor(self._hand_on)
        act = self.duty.check(now, self._status(now, reported))
        if act is not None:
            self._command(act)
        self._publish(act)

    def _status(self, now: float, reported: list[MachineState]) -> GatewayStatus:
        gateway, scheduler, is_lost = self._gateway, self._scheduler, self.duty.lost_since is not None
        if scheduler.alive:
            self._held_at = now
        if gateway.alive and not is_lost:
            return GatewayStatus(alive=True)
        if reported and not is_lost:  # not of a successor, which has no samples yet and reports a motion
            self._state = reported[-1]
        state = self._state
        run_lost = scheduler.goal != NOBODY and not scheduler.alive and now - self._held_at < TOGETHER
        busy = state is None or state.moving or bool(state.goal or state.owner)
        return GatewayStatus(gateway.alive, gateway.left, bool(reported), busy, run_lost)

    def _command(self, act: Act) -> None:
        self._controls.zero()  # messages leave sooner than requests
        if act is Act.EMERGENCY:
            self._controls.emergency(True)
            self._stood_in.publish(self._now())
        self._controls.cancel_everything()
        if self.duty.lost_since is not None:
            self._acts.publish(Bool(data=True))  # a goal that leaves now would be cancelled

    def pressed(self) -> None:
        """The stop button is pressed."""
        self._press.since = monotonic()

    def _hand_on(self) -> None:
        """Tell a gateway of the press that it did not live to remember."""
        self._log.error("press_handed_on", machine=self.machine)
        request = StopMachine.Request(cause=to_line(SoftwareStop()), orderly=False)
        self._ros.call_then(StopMachine, f"/{self.machine}/rc/stop", request, _told)

    def _publish(self, act: Act | None) -> None:
        lost = self.duty.lost_since is not None
        if lost and act not in (None, self._done):
            if self._done is None:
                STOOD_IN.labels(self.machine).inc()
                LOST.labels(self.machine).set(1)
            self._done = act
            self._log.error("gateway_lost", machine=self.machine, action=act and act.value)
        elif not lost and self._done is not None:
            self._done = None
            self._acts.publish(Bool(data=False))
            LOST.labels(self.machine).set(0)
            self._log.info("gateway_back", machine=self.machine)
        elif not lost and act is not None:
            self._log.info("gateway_left", machine=self.machine)


class Standby:
    """The standbys of the gateways that run on this PC."""

    def __init__(self, app: App) -> None:
        rows = [row for row in here(app.site) if row.module == GATEWAY]
        self._standbys = {row.full: StandbyGateway(app, str(row.machine)) for row in rows}
        if self._standbys:
            app.pulse.add(self._check)
            self._notes = PressedNotes(app, [one.machine for one in self._standbys.values()])
            app.ros.subscribe(Bool, "/emergency_signal", self._signal, depth=SIGNALS)

    def silent(self) -> dict[str, float]:
        """Gateways that are lost, and for how long [s]; from any thread."""
        now = monotonic()
        since = {name: one.duty.lost_since for name, one in self._standbys.items()}
        return {name: now - at for name, at in since.items() if at is not None}

    def _signal(self, message: Bool) -> None:
        if message.data:
            self._notes.pressed()
            for one in self._standbys.values():
                one.pressed()

    def _check(self) -> None:
        now = monotonic()
        for one in self._standbys.values():
            one.check(now)


def _told(_answer: StopMachine.Response) -> None:
    """The state of the gateway shows whether it is latched."""


def _looked_at(permit: RemotePermit) -> None:
    """No callback is needed: `StandbyGateway` reads its permits at every beat."""
