"""Metrics of finished cycles, since the start of the process."""

from collections.abc import Iterable, Mapping

from prometheus_client import Counter

from tms_work.cycle import PARTS as PARTS_OF
from tms_work.cycle import Cycle, Kind

LABELS = ("machine", "kind")
CYCLES = Counter("tms_ground_cycles_total", "Finished cycles: buckets of excavators, ways of carriers", LABELS)
BANK = Counter("tms_ground_moved_bank_cubic_metres_total", "Soil of finished cycles, as it lay", LABELS)
LOOSE = Counter("tms_ground_moved_loose_cubic_metres_total", "Soil of finished cycles, as it was carried", LABELS)
MASS = Counter("tms_ground_moved_kilograms_total", "Soil of finished cycles", LABELS)
FILL = Counter("tms_ground_cycle_fill_ratio_total", "Sum of the fill factors of finished cycles", LABELS)
PARTS = Counter("tms_ground_cycle_part_seconds_total", "Time of finished cycles by part", [*LABELS, "part"])
UNSEEN = Counter("tms_ground_cycle_unseen_seconds_total", "Time of finished cycles in which nobody looked", LABELS)
DISTANCE = Counter("tms_ground_cycle_metres_total", "Way driven in finished cycles", LABELS)


def begin(kinds: Mapping[str, Kind]) -> None:
    """Begin at 0 for these machines: Prometheus does not see the first step of a counter that appears with it."""
    for labels in kinds.items():
        for counter in (CYCLES, BANK, LOOSE, MASS, FILL, DISTANCE, UNSEEN):
            counter.labels(*labels)
        for part in PARTS_OF[labels[1]]:
            PARTS.labels(*labels, part)


def counted(cycles: Iterable[Cycle]) -> None:
    """Count finished cycles."""
    for one in cycles:
        labels = one.machine, one.kind
        CYCLES.labels(*labels).inc()
        for counter, value in ((BANK, one.bank), (LOOSE, one.loose), (MASS, one.mass), (FILL, one.fill or 0.0),
                               (DISTANCE, one.distance), (UNSEEN, one.unseen)):  # fmt: skip
            counter.labels(*labels).inc(value)
        for part, seconds in one.parts.items():
            PARTS.labels(*labels, part).inc(seconds)
