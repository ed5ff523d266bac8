"""Metrics of finished cycles, since the start of the process."""

from collections.abc import Iterable

from prometheus_client import Counter

from tms_work.cycle import Cycle

LABELS = ("machine", "kind")
CYCLES = Counter("tms_ground_cycles_total", "Finished cycles: buckets of excavators, ways of carriers", LABELS)
BANK = Counter("tms_ground_moved_bank_cubic_metres_total", "Soil of finished cycles, as it lay", LABELS)
LOOSE = Counter("tms_ground_moved_loose_cubic_metres_total", "Soil of finished cycles, as it was carried", LABELS)
MASS = Counter("tms_ground_moved_kilograms_total", "Soil of finished cycles", LABELS)
FILL = Counter("tms_ground_cycle_fill_ratio_total", "Sum of the fill factors of finished cycles", LABELS)
PARTS = Counter("tms_ground_cycle_part_seconds_total", "Time of finished cycles by part", [*LABELS, "part"])
DISTANCE = Counter("tms_ground_cycle_metres_total", "Way driven in finished cycles", LABELS)


def counted(cycles: Iterable[Cycle]) -> None:
    """Count finished cycles."""
    for one in cycles:
        labels = one.machine, one.kind
        CYCLES.labels(*labels).inc()
        for counter, value in ((BANK, one.bank), (LOOSE, one.loose), (MASS, one.mass), (FILL, one.fill or 0.0),
                               (DISTANCE, one.distance)):  # fmt: skip
            counter.labels(*labels).inc(value)
        for part, seconds in one.parts.items():
            PARTS.labels(*labels, part).inc(seconds)
