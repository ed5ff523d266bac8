"""One gateway per machine: each asserts its claim, and a gateway that finds another one serving does not serve."""

import os
import secrets
import socket

from prometheus_client import Gauge
from tms_msg_rc.msg import GatewayClaim

from tms_config.clock import monotonic, sleep
from tms_decision.permit_link import LEASE
from tms_machine.permit import AGAIN
from tms_rc.reasons import Rival
from tms_reason.reason import Reason
from tms_runtime import leases
from tms_runtime.app import App

SETTLE = 0.4  # s for gateways to discover each other; a gateway that is discovered later is reported then
CLAIM_CHECK_PERIOD = 0.1  # s
GATEWAYS = Gauge("tms_rc_gateways", "Gateways of this machine, this one included; more than one is a mistake")


class Claim:
    """The claim of this process. All methods but `rival` and `serve` run on the executor thread."""

    def __init__(self, app: App) -> None:
        self._app, self._id, self._serving = app, secrets.token_hex(8), False
        self._where = f"pid {os.getpid()} on {socket.gethostname()}"
        self._others: dict[str, GatewayClaim] = {}
        self._alive, self._asserted = 1, 0.0
        GATEWAYS.set(1)
        topic = f"/{app.machine}/rc/claim"
        self._publisher = app.ros.lease_publisher(GatewayClaim, topic, LEASE)
        app.ros.on_executor(
            lambda: leases.subscribe(app.ros, GatewayClaim, topic, LEASE, self._on_claim, self._on_liveliness)
        )
        self._publish()
        app.pulse.add(self._beat)

    @property
    def rival(self) -> Reason | None:
        """Another gateway for this machine."""
        other = self._other()
        return Rival(self._app.machine, other.where) if other is not None else None

    def serve(self) -> bool:
        """Wait until no other gateway serves, then publish that this one does; False when the process ends before."""
        self._app.stopping.wait(SETTLE)
        reported = False
        while not self._app.stopping.is_set():
            other = self._other()
            if other is None or not (other.serving or other.id < self._id):
                break
            if not reported:
                self._app.log.error("second_gateway", other=other.where, action="does not serve")
                reported = True
            sleep(CLAIM_CHECK_PERIOD)
        if self._app.stopping.is_set():
            return False
        self._serving = True
        self._publish()
        return True

    def _other(self) -> GatewayClaim | None:
        others = list(self._others.values())
        return others[-1] if others and self._alive > 1 else None

    def _publish(self) -> None:
        self._publisher.publish(GatewayClaim(id=self._id, serving=self._serving, where=self._where))

    def _beat(self) -> None:
        now = monotonic()
        if now - self._asserted > AGAIN:
            self._asserted = now
            self._publisher.assert_liveliness()

    def _on_claim(self, claim: GatewayClaim) -> None:
        if claim.id == self._id:
            return
        self._others.pop(claim.id, None)
        self._others[claim.id] = claim
        self._alive = max(self._alive, 2)
        self._judge()

    def _on_liveliness(self, alive: int, _not_alive: int) -> None:
        self._alive = max(1, alive)
        if alive <= 1:
            self._others.clear()
        self._judge()

    def _judge(self) -> None:
        other = self._other()
        GATEWAYS.set(1 if other is None else self._alive)
        if other is None or not self._serving or not other.serving:
            return
        if other.id < self._id:  # both served before they discovered each other: one of them ends and is restarted
            self._app.log.error("second_gateway", other=other.where, action="ends")
            self._app.ros.failed.set()
