"""Stops that a run asks for: straight to the gateways, which prove that the machines stand."""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor

from tms_msg_rc.msg import StopReceipt
from tms_msg_rc.srv import StopMachine

from tms_config.clock import monotonic
from tms_decision import RECEIPT_LIMIT
from tms_decision.gateway.stops import stood_after
from tms_decision.reasons import MachineUnconfirmed, ProcessLost, StopUnconfirmed
from tms_machine.reasons import NoReason
from tms_reason import wire
from tms_reason.errors import RosError
from tms_reason.reason import Reason
from tms_reason.wire import to_line
from tms_ros.node import Ros
from tms_ts.gateways import Gateways
from tms_ts.reasons import MachineStood, MachineStoodBy

GATEWAY_LIMIT = 3.0  # s for a lost gateway to come back

LogEvent = Callable[[str, str, Reason], None]  # kind, node path, what: for the journal


class MachineStops:
    """The stops of one run. Any thread may call."""

    def __init__(self, ros: Ros, gateways: Gateways, log_event: LogEvent) -> None:
        self._ros, self._gateways, self._log_event = ros, gateways, log_event
        self._reported: set[tuple[str, int, int]] = set()  # receipts in the journal

    def stop(self, machine: str, cause: Reason) -> StopReceipt:
        """Have the gateway stop the machine and watch it stand. Blocks; never raises.

        If the gateway is lost meanwhile, its successor is asked again.
        """
        line, deadline = to_line(cause), monotonic() + RECEIPT_LIMIT
        while True:
            self._gateways.wait_alive(machine, GATEWAY_LIMIT)
            request = StopMachine.Request(cause=line, orderly=True)
            lost = self._gateways.loss(machine)
            try:
                answer = self._ros.call(StopMachine, f"/{machine}/rc/stop", request, RECEIPT_LIMIT, lost)
            except RosError as error:
                if isinstance(error.reason, ProcessLost) and monotonic() < deadline:
                    continue
                stamp, why = self._ros.now(), to_line(error.reason)
                return StopReceipt(machine=machine, confirmed=False, cause=line, detail=why, stamp=stamp)
            return answer.receipt

    def stop_all(self, machines: Sequence[str], cause: Reason) -> list[StopReceipt]:
        """`stop` for several machines at the same time."""
        if not machines:
            return []
        with ThreadPoolExecutor(len(machines), "stop") as pool:
            return list(pool.map(lambda machine: self.stop(machine, cause), machines))

    def receipt(self, receipt: StopReceipt) -> None:
        """Put a stop into the journal once: its receipt comes as an answer and on a topic."""
        key = (receipt.machine, receipt.stamp.sec, receipt.stamp.nanosec)
        if key not in self._reported:
            self._reported.add(key)
            self._log_event("stop", "", reported_by(receipt))


def reported_by(receipt: StopReceipt) -> Reason:
    """A receipt as a reason."""
    cause, evidence = wire.of(receipt.cause) or NoReason(), wire.of(receipt.evidence)
    if not receipt.confirmed:
        why = StopUnconfirmed(wire.of(receipt.detail) or NoReason(), cause)
        return MachineUnconfirmed(receipt.machine, why)
    stood = stood_after(receipt.seconds, receipt.travel_joint, receipt.travel_rad, receipt.travel_m, cause)
    return (
        MachineStood(receipt.machine, stood) if evidence is None else MachineStoodBy(receipt.machine, stood, evidence)
    )
