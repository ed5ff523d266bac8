"""The scheduler's side of the gateways: its permits, their states and receipts, and a stop when one is lost."""

from collections.abc import Callable
from dataclasses import dataclass

from std_msgs.msg import Bool
from tms_msg_rc.msg import MachineState, StopReceipt
from tms_msg_rc.srv import StopMachine

from tms_config.clock import monotonic, sleep
from tms_decision.duty import Press
from tms_decision.owner import Owner
from tms_decision.permit_link import NOBODY
from tms_decision.reasons import DrivenByHand, MachineLatched, ProcessAway, SoftwareStop
from tms_machine.border import Controls
from tms_machine.permit import Permit, RemotePermit
from tms_machine.reasons import NoReason
from tms_reason import wire
from tms_reason.reason import Reason
from tms_runtime.app import App
from tms_runtime.fence import goal_id
from tms_schedulers.names import schedulers
from tms_ts.reasons import MachineNotReady
from tms_ts.run_permit import RunPermit

SETTLE = 0.3  # s from the first message of a new gateway until it has discovered the scheduler, too
SIGNALS = 100  # messages of all stop buttons that may wait: no `false` of one may push out the `true` of another


@dataclass(frozen=True)
class Holder:
    """A run that receives gateways' messages; its functions are called on the executor thread and return at once."""

    number: int  # fencing number
    started: tuple[int, int]  # s and ns of the wall clock
    stopped: Callable[[str, Reason], None]  # machine, cause: it was stopped from outside and stays so
    receipt: Callable[[StopReceipt], None]
    alive: Callable[[], bool]

    def concerns(self, receipt: StopReceipt) -> bool:
        """Whether a stop belongs to this run: a gateway that starts publishes its old receipts, also of other runs."""
        if receipt.run == 0:  # the gateway knew of no run
            return (receipt.stamp.sec, receipt.stamp.nanosec) >= self.started
        return receipt.run == self.number


class Gateways:
    """The gateways of all machines of the site."""

    def __init__(self, app: App, late_receipt: Callable[[StopReceipt], None]) -> None:
        """`late_receipt` is called with stops that belong to no present run; those that gateways keep come at once."""
        self._app, self._late_receipt = app, late_receipt
        self._several = len(schedulers(app.site)) > 1
        self._states: dict[str, MachineState] = {}
        self._gateways: dict[str, RemotePermit] = {}
        self._controls: dict[str, Controls] = {}
        self._permits: dict[str, RunPermit] = {}
        self._holders: dict[str, Holder] = {}
        self._presses = {machine: Press() for machine in app.site.file.machines}
        for machine in app.site.file.machines:
            self._attend(machine)
        app.ros.subscribe(Bool, "/emergency_signal", self._signal, depth=SIGNALS)

    def _attend(self, machine: str) -> None:
        ros, pulse = self._app.ros, self._app.pulse
        ros.prepare(StopMachine, f"/{machine}/rc/stop")
        self._controls[machine] = Controls(ros, machine, self._app.site.border(machine), keeps_emergency=False)
        self._permits[machine] = RunPermit(
            ros, lambda: Permit(ros, pulse, machine, "ts", lambda: self._alive(machine)), self._several
        )
        self._gateways[machine] = RemotePermit(
            ros, self._app.pulse, machine, "rc", lambda gateway: self._gateway_changed(machine, gateway)
        )
        ros.subscribe(MachineState, f"/{machine}/rc/state", lambda state: self._state(machine, state), latched=True)
        ros.subscribe(StopReceipt, f"/{machine}/rc/receipts", self._receipt, depth=20, latched=True)

    # permits

    def hold(self, machines: list[str], run_id: str, holder: Holder) -> None:
        """Publish permits for a run that moves these machines."""
        for machine in machines:
            if machine in self._permits:
                self._holders[machine] = holder
                self._permits[machine].hold(goal_id(Owner(holder.number)), run_id)

    def drop(self, machines: list[str]) -> None:
        """End the permits of a run that is over and whose machines were stopped."""
        for machine in machines:
            if self._holders.pop(machine, None) is not None:
                self._permits[machine].drop()

    def _alive(self, machine: str) -> bool:
        holder = self._holders.get(machine)
        return holder is not None and holder.alive()

    # messages

    def obstacle(self, machine: str) -> Reason | None:
        """Why a goal would not move the machine now; None if it would, or if nothing is known of it."""
        gateway, state = self._gateways.get(machine), self._states.get(machine)
        if gateway is None or state is None:
            return None
        if not gateway.alive:
            return ProcessAway(f"{machine}:rc")
        found = self.held_back(machine)
        if found is not None or state.ready:
            return found
        return MachineNotReady(machine, wire.of(state.reason) or NoReason())

    def held_back(self, machine: str) -> Reason | None:
        """A state that only a person ends: the machine is latched, or is driven by hand."""
        latch, state = self.latch(machine), self._states.get(machine)
        if latch is not None:
            return MachineLatched(machine, latch)
        by_hand = wire.of(state.by_hand) if state is not None else None
        return None if by_hand is None else DrivenByHand(by_hand, machine)

    def wait_alive(self, machine: str, seconds: float) -> None:
        """Wait for a gateway that is being restarted, so that a request to it does not get lost."""
        gateway, deadline = self._gateways.get(machine), monotonic() + seconds
        if gateway is None or gateway.alive:
            return
        while monotonic() < deadline:
            sleep(0.02)
            if self._gateways[machine].alive:
                sleep(SETTLE)
                return

    def loss(self, machine: str) -> Callable[[], bool]:
        """A function that says whether a request to the gateway must be repeated.

        It must if the gateway is lost after this call, or if it is lost now and its successor comes later.
        """
        gateway = self._gateways.get(machine)
        if gateway is None:
            return lambda: False
        alive = gateway.alive
        return lambda: gateway.alive != alive

    def latch(self, machine: str) -> Reason | None:
        """Why the machine is latched until it is re-armed; None if it is not."""
        state = self._states.get(machine)
        return wire.of(state.latch) if state is not None else None

    def _state(self, machine: str, state: MachineState) -> None:
        self._states[machine] = state
        if self._presses[machine].due(monotonic(), self._gateways[machine].alone, bool(state.latch)):
            self._hand_on(machine)
        holder = self._holders.get(machine)
        if holder is not None and state.latch:
            holder.stopped(machine, wire.known(state.latch))

    def _receipt(self, receipt: StopReceipt) -> None:
        holder = self._holders.get(receipt.machine)
        if holder is not None and holder.concerns(receipt):
            holder.receipt(receipt)
        else:
            self._late_receipt(receipt)

    def _signal(self, message: Bool) -> None:
        if message.data:
            for press in self._presses.values():
                press.since = monotonic()
            for machine, holder in list(self._holders.items()):
                holder.stopped(machine, SoftwareStop())

    def _hand_on(self, machine: str) -> None:
        """Tell a gateway of a press that it does not know, also if its host agent was away as well."""
        self._app.log.error("press_handed_on", machine=machine)
        request = StopMachine.Request(cause=wire.to_line(SoftwareStop()), orderly=False)
        self._app.ros.call_then(StopMachine, f"/{machine}/rc/stop", request, _told)

    def _gateway_changed(self, machine: str, gateway: RemotePermit) -> None:
        """Stop the machine of a lost gateway at once, as the gateway would; its successor does the same, but later."""
        if gateway.alive:
            return
        self._presses[machine].due(monotonic(), alive=False, latched=None)
        if gateway.goal == NOBODY:
            return
        self._controls[machine].zero()
        self._controls[machine].cancel_everything()
        self._app.log.warning("gateway_lost", machine=machine, action="cancelled its goals")


def _told(_answer: StopMachine.Response) -> None:
    """The state of the gateway shows whether it is latched."""
