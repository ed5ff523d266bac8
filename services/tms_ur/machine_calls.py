"""Machines as the API commands them: blocking calls of their gateways, for worker threads."""

from tms_msg_rc.srv import Rearm, StopMachine, TakeMachine

from tms_decision import RECEIPT_LIMIT
from tms_reason import wire
from tms_reason.errors import RosError
from tms_reason.reason import Reason
from tms_runtime.priority import URGENT, undisturbed
from tms_ur import gateway_areas, messages
from tms_ur.answers import checked
from tms_ur.models import Rearmed, Receipt
from tms_ur.reason_view import of_error, of_line, view
from tms_ur.run_calls import RunCalls


class MachineCalls(RunCalls):
    """What is asked of gateways about their machines."""

    def stop(self, machine: str, cause: Reason) -> Receipt:
        """Stop one machine by a call of its gateway; where no answer comes, the receipt says that."""
        try:
            request = StopMachine.Request(cause=wire.to_line(cause))
            with undisturbed(URGENT):
                answer = self._ros.call(StopMachine, f"/{machine}/rc/stop", request, RECEIPT_LIMIT)
        except RosError as error:
            return Receipt(
                machine=machine, confirmed=False, seconds=0.0, travel_joint="", travel_rad=0.0, travel_m=0.0,
                cause=view(cause), detail=of_error(error), evidence=None, latched=False,
            )  # fmt: skip
        return messages.receipt(answer.receipt)

    def rearm(self, machine: str, token: str) -> Rearmed:
        """One step of re-arming.

        Raises:
            TmsError: refused, with the reason.
        """
        answer = self._ask(Rearm, f"/{machine}/rearm", token=token)
        return Rearmed(token=answer.token, cause=of_line(answer.cause), armed=answer.armed)

    def let_back(self, machine: str, who: str) -> None:
        """Let a machine that stands outside its areas be moved back in; a TmsError says why not."""
        gateway_areas.let_back(self._ros, machine, who)

    def give_back(self, machine: str, who: str) -> Receipt:
        """End driving by hand, with the gateway's proof that the machine stands.

        Raises:
            TmsError: the gateway refuses, or is away.
        """
        request = TakeMachine.Request(who=who, back=True)
        answer = self._ros.call(TakeMachine, f"/{machine}/take", request, RECEIPT_LIMIT)
        return messages.receipt(checked(answer).receipt)
