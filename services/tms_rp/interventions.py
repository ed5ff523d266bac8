"""Whether somebody has taken a machine out of its planner's hands while a motion waits to go on."""

from tms_msg_rc.msg import MachineState

from tms_decision.reasons import DrivenByHand, Held, MachineLatched
from tms_machine.reasons import NoReason
from tms_reason import wire
from tms_reason.reason import Reason
from tms_ros.node import Ros


class Interventions:
    """Hears from the gateway when the machine is latched, held or driven by hand, also if that has ended since."""

    def __init__(self, ros: Ros, machine: str) -> None:
        self._machine = machine
        self._heard: Reason | None = None
        ros.subscribe(MachineState, f"/{machine}/rc/state", self._take, latched=True)

    def forget(self) -> None:
        """Forget what was; a state that lasts is told again within half a second."""
        self._heard = None

    @property
    def heard(self) -> Reason | None:
        """The first one since `forget`."""
        return self._heard

    def _take(self, state: MachineState) -> None:
        if self._heard is None:
            self._heard = self._reason(state)

    def _reason(self, state: MachineState) -> Reason | None:
        if state.latch:
            return MachineLatched(self._machine, wire.of(state.latch) or NoReason())
        if state.hold:
            return Held(wire.of(state.hold) or NoReason())
        if state.by_hand:
            return DrivenByHand(wire.of(state.by_hand) or NoReason(), self._machine)
        return None
