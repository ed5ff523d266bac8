"""Stops a machine and proves it: commands at once, then watches until it stands, then a receipt.

The commands leave in the caller's thread, which is the executor thread for software stops and lost permits: nothing
here waits for a database, a scheduler, a console or a lock that one of those holds.
"""

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from prometheus_client import Counter, Histogram
from tms_msg_rc.msg import StopReceipt

from tms_core.app import App
from tms_core.border import Controls
from tms_rc.standstill import StandStill

STOP_LIMIT = 5.0  # s to be seen standing
AGAIN = 0.5  # s between repeated commands while it does not stand
LOOK = 0.01  # s

STOPS = Counter("tms_rc_stops_total", "Stops by whether the machine was seen to stand", ["confirmed"])
for _answer in ("yes", "no"):  # a series that only appears with its first stop has no increase to alert on
    STOPS.labels(_answer)
STOP_SECONDS = Histogram(
    "tms_rc_stop_seconds", "From the wish to stop until the machine stood", buckets=(0.1, 0.2, 0.35, 0.5, 0.7, 1, 2, 5)
)


@dataclass
class Stop:
    """One stop; `receipt` is set before `over`."""

    cause: str
    latched: bool
    run: int
    ended: Callable[[], bool]  # whether the goal that was stopped is terminal
    begun: float
    stamp: Any
    receipt: StopReceipt | None = None
    over: threading.Event = field(default_factory=threading.Event)


class Stopper:
    """Of one machine; several stops may be under way."""

    def __init__(
        self,
        app: App,
        controls: Controls,
        watch: StandStill,
        unready: Callable[[], str | None],
        proof: Callable[[Stop], None],
    ) -> None:
        """`proof` is called in the stop's own thread, after its commands and again with the receipt."""
        self._proof = proof
        self._app, self._controls, self._watch, self._unready = app, controls, watch, unready
        self._under_way: list[Stop] = []
        self._receipts = app.ros.publisher(StopReceipt, f"/{app.machine}/rc/receipts", depth=20, latched=True)

    def begin(self, cause: str, *, latched: bool, run: int = 0, ended: Callable[[], bool] = lambda: True) -> Stop:
        """Command the stop now and have it watched; returns at once."""
        stop = Stop(cause, latched, run, ended, time.monotonic(), self._app.ros.now())
        self._command(latched)
        if not self._under_way:
            self._watch.mark()
        self._under_way.append(stop)
        threading.Thread(target=self._prove, args=(stop,), name="stop", daemon=True).start()
        return stop

    def _command(self, latched: bool) -> None:
        self._controls.zero()  # messages leave sooner than requests
        if latched:
            self._controls.emergency(True)
        self._controls.cancel_everything()

    def _prove(self, stop: Stop) -> None:
        """Watch until the machine stands, repeating the commands; then tell."""
        self._proof(stop)
        now, again = stop.begun, stop.begun + AGAIN
        while not self._seen(stop, now) and now - stop.begun < STOP_LIMIT:
            time.sleep(LOOK)
            now = time.monotonic()
            if self._app.ros.closing:
                return  # the successor stops the machine again and writes the receipt
            if now > again:
                again = now + AGAIN
                self._command(stop.latched)
        stop.receipt = self._receipt(stop, now)
        self._proof(stop)
        self._tell(stop.receipt)
        self._under_way.remove(stop)
        stop.over.set()

    def _seen(self, stop: Stop, now: float) -> bool:
        return stop.ended() and self._watch.standing(now)

    def _receipt(self, stop: Stop, now: float) -> StopReceipt:
        confirmed = self._seen(stop, now)
        obstacle = self._unready() or ("still moving" if self._watch.moving() else "its goal is still open")
        return StopReceipt(
            machine=self._app.machine, confirmed=confirmed, seconds=now - stop.begun, travel=self._watch.travel(),
            cause=stop.cause, detail="" if confirmed else obstacle, stamp=stop.stamp,
            latched=stop.latched or not confirmed, run=stop.run,
        )  # fmt: skip

    def _tell(self, receipt: StopReceipt) -> None:
        STOPS.labels("yes" if receipt.confirmed else "no").inc()
        STOP_SECONDS.observe(receipt.seconds)
        self._receipts.publish(receipt)
        self._app.log.info("event=stop cause=%r confirmed=%s latched=%s seconds=%.3f travel=%.3f detail=%r",
                           receipt.cause, receipt.confirmed, receipt.latched, receipt.seconds, receipt.travel,
                           receipt.detail)  # fmt: skip
