"""What machines carry while a run goes on, as tms:ground tells it: bars for people, sums of what went in and out."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from tms_cli.words import say
from tms_config.config import Site

if TYPE_CHECKING:
    from tms_msg_ground.msg import SoilLoad

    from tms_ros.node import Ros

BAR = 20  # letters
NEWS = 0.2  # of what a machine holds: a change that is worth a line
EMPTY, HOLDS = 0.1, 0.3  # of what a bucket holds: below and above which it is empty and has dug


@dataclass
class Carried:
    """One machine's load, and its sums since the first message; volumes in m3."""

    bucket: bool  # else a vessel
    loose: float = 0.0
    bank: float = 0.0
    capacity: float = 0.0
    in_loose: float = 0.0
    in_bank: float = 0.0
    out_loose: float = 0.0
    emptied: int = 0  # times
    heard: bool = False
    _has_dug: bool = False
    _shown: float = 0.0

    def take(self, loose: float, bank: float, capacity: float) -> None:
        """Take a load as it is now."""
        if self.heard:
            self.in_loose += max(0.0, loose - self.loose)
            self.in_bank += max(0.0, bank - self.bank)
            self.out_loose += max(0.0, self.loose - loose)
        self._has_dug = self._has_dug or loose > HOLDS * capacity
        if self._has_dug and loose < EMPTY * capacity:
            self.emptied, self._has_dug = self.emptied + 1, False
        self.loose, self.bank, self.capacity, self.heard = loose, bank, capacity, True

    def is_news(self) -> bool:
        """Whether it has changed by much since this was last so."""
        if not self.heard or abs(self.loose - self._shown) < NEWS * self.capacity:
            return False
        self._shown = self.loose
        return True

    def line(self, machine: str) -> str:
        """A bar and figures."""
        full = round(BAR * min(1.0, self.loose / self.capacity)) if self.capacity > 0 else 0
        figures = {"loose": f"{self.loose:.2f}", "capacity": f"{self.capacity:.2f}"}
        part = say("bucket") if self.bucket else say("vessel")
        bar = "█" * full + "░" * (BAR - full)
        return f"{machine}: {part} {bar} " + say("{loose} of {capacity} m³", **figures)


class Loads:
    """Those of all machines of a site that have a bucket or a vessel; none where the site has no ground."""

    def __init__(self, node: Ros, site: Site) -> None:
        self.of: dict[str, Carried] = {}  # by machine
        if site.file.ground is None:
            return
        from tms_msg_ground.msg import SoilLoad

        for name in site.file.machines:
            model = site.model_of(name)
            if model.bucket or model.vessel:
                self.of[name] = Carried(model.bucket is not None)
                node.subscribe(SoilLoad, f"/{name}/soil_load", self._receiver(self.of[name]))

    @staticmethod
    def _receiver(carried: Carried) -> Callable[[SoilLoad], None]:
        return lambda load: carried.take(load.loose, load.bank, load.capacity)

    def lines(self) -> list[str]:
        """One line a machine, as far as it was told."""
        return [one.line(name) for name, one in self.of.items() if one.heard]

    def news(self) -> list[str]:
        """Lines of the machines whose load has changed by much since the last call."""
        return [one.line(name) for name, one in self.of.items() if one.is_news()]
