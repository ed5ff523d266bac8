"""How the ground has changed in a day, by the grounds that were stored."""

from dataclasses import dataclass
from datetime import datetime
from typing import Protocol

from tms_report import ground_map, map_picture
from tms_report.facts import GroundChange
from tms_soil.surface import Heights
from tms_soil.volumes import between


@dataclass(frozen=True)
class Stored:
    """A ground that was stored."""

    taken_at: datetime
    heights: Heights


class Kept(Protocol):
    """Reads stored grounds."""

    def __call__(self, which: str, begin: datetime | None, end: datetime) -> Stored | None:
        """The `first` or the `last` ground from `begin` on and before `end`; None: there is none."""


def change_in(kept: Kept, begin: datetime, end: datetime) -> GroundChange | None:
    """From the last ground before a span, or its first one, to its last one; None without two of them."""
    after = kept("last", begin, end)
    if after is None:
        return None
    before = kept("last", None, begin) or kept("first", begin, end)
    if before is None or before.taken_at == after.taken_at:
        return None
    rise = ground_map.change(before.heights, after.heights)
    first, last = (one.taken_at.astimezone().strftime("%Y-%m-%d %H:%M") for one in (before, after))
    picture, full = map_picture.picture(after.heights, rise), ground_map.full_colour(rise)
    return GroundChange(first, last, between(before.heights, after.heights), full, picture)
