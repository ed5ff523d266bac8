"""Receipts of stops as messages: kept ones first, then each when it is told."""

from collections.abc import Callable

from prometheus_client import Counter, Histogram
from tms_msg_rc.msg import StopReceipt

from tms_decision.gateway.effects import Receipt, Tell
from tms_machine import stamps
from tms_rc.receipts import Receipts
from tms_rc.shell import Shell
from tms_reason.wire import to_line
from tms_ros.packing import unpack
from tms_runtime.app import App

STOPS = Counter("tms_rc_stops_total", "Stops by whether the machine was seen to stand", ["confirmed"])
for _answer in ("yes", "no"):  # a series that first appears with its first stop has no increase for an alert
    STOPS.labels(_answer)
STOP_SECONDS = Histogram(
    "tms_rc_stop_seconds", "From the wish to stop until it was proven", buckets=(0.35, 0.5, 0.7, 1, 1.5, 2, 3, 5, 10)
)


def message_of(receipt: Receipt, machine: str) -> StopReceipt:
    """A receipt as a message."""
    return StopReceipt(
        machine=machine, confirmed=receipt.confirmed, seconds=receipt.seconds, cause=to_line(receipt.cause),
        travel_joint=receipt.joint, travel_rad=receipt.angle, travel_m=receipt.way, detail=to_line(receipt.detail),
        stamp=stamps.time(receipt.stamp), latched=receipt.latched, run=receipt.run, evidence=to_line(receipt.evidence),
    )  # fmt: skip


class ReceiptTopic:
    """Publishes receipts, the last ones again after a restart."""

    def __init__(self, app: App, shell: Shell, kept: Receipts) -> None:
        self._app = app
        self._publisher = app.ros.publisher(StopReceipt, f"/{app.machine}/rc/receipts", depth=20, latched=True)
        for data in kept.all():
            self._publisher.publish(unpack(data, StopReceipt))
        self.heard: Callable[[Receipt], None] | None = None  # who else wants them, without waiting
        shell.does(Tell, self._tell)

    def _tell(self, effect: Tell) -> None:
        receipt = effect.receipt
        if self.heard is not None:
            self.heard(receipt)
        STOPS.labels("yes" if receipt.confirmed else "no").inc()
        STOP_SECONDS.observe(receipt.seconds)
        self._publisher.publish(message_of(receipt, self._app.machine))
        self._app.log.info(
            "stop",
            cause=receipt.cause,
            confirmed=receipt.confirmed,
            latched=receipt.latched,
            seconds=round(receipt.seconds, 3),
            joint=receipt.joint,
            rad=round(receipt.angle, 3),
            m=round(receipt.way, 3),
            detail=receipt.detail or "",
        )
