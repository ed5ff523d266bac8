"""Machines as the API commands them: blocking calls of their gateways, for worker threads."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from queue import Empty, Queue

from tms_msg_rc.srv import Rearm, StopMachine, TakeMachine

from tms_config.naming import process_of
from tms_decision import RECEIPT_LIMIT
from tms_reason import wire
from tms_reason.errors import RosError
from tms_reason.reason import Reason
from tms_ros.reasons import NoAnswer
from tms_runtime.priority import URGENT, undisturbed
from tms_ur import gateway_areas, messages
from tms_ur.answers import checked
from tms_ur.models import Rearmed, Receipt
from tms_ur.reason_view import of_error, of_line, view
from tms_ur.run_calls import RunCalls


class MachineCalls(RunCalls):
    """What is asked of gateways about their machines."""

    def stop(self, machines: list[str], cause: Reason) -> list[Receipt]:
        """Stop machines by calls of their gateways; where no answer comes, the receipt says that.

        One thread asks all of them before anybody waits for an answer: threads of their own began one by one on full
        processors, and the tenth gateway heard of the stop after 2.3 s.
        """
        request = StopMachine.Request(cause=wire.to_line(cause))
        answers = {machine: Queue[StopMachine.Response](1) for machine in machines}
        with undisturbed(URGENT):
            drops = {one: self._ros.call_then(StopMachine, _stop(one), request, answers[one].put) for one in machines}

        def answered(machine: str) -> Receipt:
            try:
                if (drop := drops[machine]) is not None:
                    answer = _in_time(machine, answers[machine], drop)
                else:  # its gateway is not there yet
                    with undisturbed(URGENT):
                        answer = self._ros.call(StopMachine, _stop(machine), request, RECEIPT_LIMIT)
            except RosError as error:
                return Receipt(
                    machine=machine, confirmed=False, seconds=0.0, travel_joint="", travel_rad=0.0, travel_m=0.0,
                    cause=view(cause), detail=of_error(error), evidence=None, latched=False,
                )  # fmt: skip
            return messages.receipt(answer.receipt)

        with ThreadPoolExecutor(max(1, len(machines)), "stop") as pool:
            return list(pool.map(answered, machines))

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


def _stop(machine: str) -> str:
    return f"/{machine}/rc/stop"


def _in_time(machine: str, answers: "Queue[StopMachine.Response]", drop: Callable[[], None]) -> StopMachine.Response:
    try:
        return answers.get(timeout=RECEIPT_LIMIT)
    except Empty:
        drop()
        raise RosError(NoAnswer(process_of(_stop(machine)), _stop(machine), RECEIPT_LIMIT)) from None
