"""Compares every receipt of a stop with the true motion, which no fault changes."""

from __future__ import annotations

import math
import time

from soak.kills import Kills
from tms_cli.drill.stop_observer import StopObserver
from tms_cli.drill.verdict import UNPROVEN, lie, text_of
from tms_config.config import Site
from tms_ros.node import Ros

EARLIER = 5.0  # s of the motion before a stop
BACK = 5.0  # s until a gateway that was killed watches its machine again
WAIT = UNPROVEN + 5.0  # s after a receipt in which what follows belongs to it


class Receipts:
    """Those of all machines."""

    def __init__(self, node: Ros, site: Site, kills: Kills) -> None:
        self._kills = kills
        self._observers = {name: StopObserver(node, site, name, None) for name in site.file.machines}
        self._judged = dict.fromkeys(self._observers, 0.0)  # until when [s since 1970]
        self.false: list[str] = []
        self.count = self.unconfirmed = 0

    def judge(self, wait: float = WAIT) -> None:
        """What came so long ago [s] that what follows is known; often enough that nothing is forgotten."""
        until = time.time() - wait
        for name, observer in self._observers.items():
            every = observer.since(self._judged[name]).receipts
            for receipt in [one for one in every if self._judged[name] < one.came <= until]:
                self.count += 1
                self.unconfirmed += not receipt.confirmed
                told = lie(receipt, observer.since(receipt.begun - EARLIER), self._watched(name, receipt.begun))
                if told:
                    self.false.append(f"{name}: {told}: {text_of(receipt, receipt.begun)}")
            self._judged[name] = until

    def _watched(self, machine: str, begun: float) -> float:
        """When a gateway that was killed about then watched its machine again."""
        hits = [at for at, killed in self._kills.done if killed == f"{machine}:rc" and abs(at - begun) < WAIT]
        return max(hits, default=-math.inf) + BACK
