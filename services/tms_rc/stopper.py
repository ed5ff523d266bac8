"""Stops a machine and proves it: commands at once, watches until the machine was seen to stand, publishes a receipt.

The commands leave in the caller's thread, which is the executor thread for software stops and lost permits: they
wait for no database, scheduler, console or disk, and for no lock that one of those holds. The order of a stop is
command, proof, note, receipt: a receipt is on the disk before it is published.
"""

import threading
from collections.abc import Callable
from dataclasses import dataclass, field

from builtin_interfaces.msg import Time
from prometheus_client import Counter, Histogram
from tms_msg_rc.msg import StopReceipt

from tms_config.clock import monotonic, sleep
from tms_machine.border import STOP_PROVEN, Controls
from tms_rc.reasons import ByArrival, GoalOpen, NoEnd, NotOnDisk
from tms_rc.receipts import Receipts
from tms_rc.standstill import NOTHING, Expected, Proof, StandStill
from tms_reason import wire
from tms_reason.reason import Reason, Several
from tms_reason.wire import to_line
from tms_ros.packing import pack, unpack
from tms_runtime.app import App

AGAIN = 0.5  # s between repeated commands while it is not proven
STANDSTILL_CHECK_PERIOD = 0.01  # s

STOPS = Counter("tms_rc_stops_total", "Stops by whether the machine was seen to stand", ["confirmed"])
for _answer in ("yes", "no"):  # a series that first appears with its first stop has no increase for an alert
    STOPS.labels(_answer)
STOP_SECONDS = Histogram(
    "tms_rc_stop_seconds", "From the wish to stop until it was proven", buckets=(0.35, 0.5, 0.7, 1, 1.5, 2, 3, 5, 10)
)
UNKEPT = Counter("tms_rc_notes_lost_total", "Latches and receipts that could not be kept on the disk")


@dataclass
class Stop:
    """One stop; `receipt` is set before `over`."""

    cause: Reason
    latched: bool
    run: int
    ended: Callable[[], bool]  # whether the stopped goal has ended
    begun: float  # s, monotonic, and on the wall clock:
    stamp: Time
    proof: Proof
    broken: Reason | None = None  # why it cannot be confirmed in any case: the machine had moved without a goal
    receipt: StopReceipt | None = None
    over: threading.Event = field(default_factory=threading.Event)

    def wait(self, machine: str) -> StopReceipt:
        """Wait for the receipt; an unconfirmed one if none comes in time."""
        self.over.wait(STOP_PROVEN + 1.0)
        return self.receipt or StopReceipt(
            machine=machine, cause=to_line(self.cause), detail=to_line(NoEnd()), stamp=self.stamp,
            latched=True, run=self.run,
        )  # fmt: skip


class Stopper:
    """Stops one machine; several stops may be under way."""

    def __init__(self, app: App, controls: Controls, watch: StandStill, note: Callable[[StopReceipt], None]) -> None:
        """`note` is called in the stop's own thread with the receipt, before it is sent, and may wait for the disk."""
        self._note = note
        self._app, self._controls, self._watch = app, controls, watch
        self._under_way: list[Stop] = []
        self._kept = Receipts(app.site.state, app.machine)
        self._keeping = threading.Lock()
        self._receipts = app.ros.publisher(StopReceipt, f"/{app.machine}/rc/receipts", depth=20, latched=True)
        for data in self._kept.all():
            self._receipts.publish(unpack(data, StopReceipt))

    @property
    def busy(self) -> bool:
        """Whether a stop is under way: its commands would end any motion that begins now."""
        return bool(self._under_way)

    def wait_idle(self, seconds: float) -> bool:
        """Wait until no stop is under way; False when the time is over."""
        deadline = monotonic() + seconds
        for stop in list(self._under_way):
            stop.over.wait(max(0.0, deadline - monotonic()))
        return not self.busy

    def begin(
        self, cause: Reason, begun: float, stamp: Time, *, latched: bool, run: int = 0,
        ended: Callable[[], bool] = lambda: True, expected: Expected = NOTHING, broken: Reason | None = None,
    ) -> Stop:  # fmt: skip
        """Watch over a stop that was asked for at `begun` [s, monotonic], `stamp`, and has been commanded by now.

        `expected`: see `StandStill.proof`.
        """
        proof = self._watch.proof(monotonic(), latched, expected)
        for earlier in self._under_way:
            proof = proof.after(earlier.proof)
        stop = Stop(cause, latched, run, ended, begun, stamp, proof, broken)
        if not self._under_way:
            self._watch.mark()
        self._under_way.append(stop)
        threading.Thread(target=self._prove, args=(stop,), name="stop", daemon=True).start()
        return stop

    def command(self, latched: bool) -> None:
        """Command a stop now; waits for nothing."""
        self._controls.zero()  # messages leave sooner than requests
        if latched:
            self._controls.emergency(True)
        self._controls.cancel_everything()

    def _prove(self, stop: Stop) -> None:
        try:
            self._watch_over(stop)
        finally:
            if not stop.over.is_set() and not self._app.ros.closing:  # a bug: the successor stops and proves anew
                self._app.ros.failed.set()

    def _watch_over(self, stop: Stop) -> None:
        """Repeat the commands until the stop is proven, then publish the receipt."""
        now, again = stop.begun, stop.begun + AGAIN
        while not self._seen(stop, now) and now - stop.begun < STOP_PROVEN:
            sleep(STANDSTILL_CHECK_PERIOD)
            now = monotonic()
            if self._app.ros.closing:
                return  # the successor stops the machine again and writes the receipt
            if now > again:
                again = now + AGAIN
                self.command(stop.latched)
        stop.receipt = self._receipt(stop, now)
        self._note(stop.receipt)
        self._publish(stop.receipt)
        self._under_way.remove(stop)
        stop.over.set()

    def _seen(self, stop: Stop, now: float) -> bool:
        return stop.ended() and self._watch.proven(stop.proof, now)

    def _receipt(self, stop: Stop, now: float) -> StopReceipt:
        seen, travel = self._seen(stop, now), self._watch.travel()
        obstacle = stop.broken or (GoalOpen() if not stop.ended() else self._watch.obstacle(now))
        confirmed, unstamped = seen and stop.broken is None, self._watch.unstamped
        return StopReceipt(
            machine=self._app.machine, confirmed=confirmed, seconds=now - stop.begun, cause=to_line(stop.cause),
            travel_joint=travel.joint, travel_rad=travel.angle, travel_m=travel.way,
            detail="" if confirmed else to_line(obstacle), stamp=stop.stamp, latched=stop.latched or not confirmed,
            run=stop.run,
            evidence=to_line(ByArrival(tuple(unstamped))) if unstamped else "",
        )  # fmt: skip

    def _publish(self, receipt: StopReceipt) -> None:
        STOPS.labels("yes" if receipt.confirmed else "no").inc()
        STOP_SECONDS.observe(receipt.seconds)
        try:
            with self._keeping:
                self._kept.keep(pack(receipt))
        except OSError as error:  # the receipt is published, with this error: a run must not wait for a full disk
            UNKEPT.inc()
            known, lost = wire.of(receipt.evidence), NotOnDisk(str(error.strerror))
            receipt.evidence = to_line(lost if known is None else Several((known, lost)))
        self._receipts.publish(receipt)
        self._app.log.info(
            "stop",
            cause=wire.known(receipt.cause),
            confirmed=receipt.confirmed,
            latched=receipt.latched,
            seconds=round(receipt.seconds, 3),
            joint=receipt.travel_joint,
            rad=round(receipt.travel_rad, 3),
            m=round(receipt.travel_m, 3),
            detail=wire.of(receipt.detail) or "",
        )
