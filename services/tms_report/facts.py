"""What a daily report tells: the work of one day, what was planned, how the ground has changed."""

from dataclasses import dataclass
from datetime import date, tzinfo
from functools import cached_property
from typing import Any

from tms_reason import texts
from tms_soil.volumes import Volumes
from tms_work import sums
from tms_work.cycle import Cycle
from tms_work.plan import Plan
from tms_work.sums import Sum


@dataclass(frozen=True)
class GroundChange:
    """How the ground has changed in the day."""

    before: str  # local time of the snapshot
    after: str  # local time of the snapshot
    volumes: Volumes
    full: float  # m, change that has the full colour in the picture
    picture: bytes  # PNG


@dataclass(frozen=True)
class Facts:
    """One day of a site, and the language to tell it in."""

    site: str
    day: date
    cycles: tuple[Cycle, ...]
    language: str
    plan: Plan | None = None
    change: GroundChange | None = None
    zone: tzinfo | None = None  # None: that of this PC

    def say(self, english: str, **values: Any) -> str:
        """A text of the report; `english` is a format string."""
        return texts.translated(english, self.language).format(**values)

    @cached_property
    def total(self) -> Sum:
        return sums.total(self.cycles)

    @cached_property
    def machines(self) -> dict[str, Sum]:
        return sums.by(self.cycles, lambda one: one.machine)

    @cached_property
    def runs(self) -> dict[str, Sum]:
        return sums.by(self.cycles, lambda one: one.run_id)

    @cached_property
    def hours(self) -> dict[int, Sum]:
        """By hour of the day, without gaps from the first to the last."""
        found = {int(name[-2:]): one for name, one in sums.by(self.cycles, sums.hour(self.zone)).items()}
        return {at: found.get(at, sums.total(())) for at in range(min(found), max(found) + 1)} if found else {}
