"""The figures over all trials. Pure logic."""

import math
from collections import Counter
from collections.abc import Sequence
from typing import Any

from tms_cli.drill.plan import NONE, How
from tms_cli.drill.verdict import HUNG, LEFT_OUT, Row

BAD = ("false_receipts", "hung", "ran_on", "unlatched", "disturbed", "not_back", "left_out")  # figures that must be 0


def percentile(values: Sequence[float], share: float) -> float | None:
    """The value that a `share` of all values does not exceed; None without values."""
    ordered = sorted(values)
    return ordered[max(0, math.ceil(share * len(ordered)) - 1)] if ordered else None


def summary(rows: Sequence[Row], seed: int) -> dict[str, Any]:
    """The document of --json."""
    tried = [row for row in rows if row.outcome != LEFT_OUT and not row.void]
    bad = Counter(name for row in rows for name in wrong(row))
    reported = [row.reported_s for row in tried if row.reported_s is not None]
    stood = [row.stood_s for row in tried if row.stood_s is not None and measured(row)]
    backs = [row.back_s for row in tried if row.back_s is not None]
    return {
        "seed": seed,
        "trials": len(tried),
        "kills": sum(row.how in (How.KILL.value, How.POWER.value) for row in tried),
        "void": sum(bool(row.void) for row in rows),
        **{name: bad[name] for name in BAD},
        "unconfirmed": sum(row.unconfirmed for row in tried),
        "unconfirmed_in_order": sum(row.unconfirmed and row.fault == NONE and _single(row) for row in tried),
        "stop_p50_s": _rounded(percentile(stood, 0.5)),
        "stop_p99_s": _rounded(percentile(stood, 0.99)),
        "kill_to_stop_p50_s": _rounded(percentile(reported, 0.5)),
        "kill_to_stop_p99_s": _rounded(percentile(reported, 0.99)),
        "kill_to_stop_max_s": _rounded(max(reported, default=None)),
        "back_max_s": _rounded(max(backs, default=None)),
        "stops": stops(tried),
        "rows": [row.as_dict() for row in rows],
    }


def wrong(row: Row) -> list[str]:
    """The figures of BAD in which a trial counts."""
    if row.void:
        return []
    if row.outcome == LEFT_OUT:
        return ["left_out"]
    holds = {
        "false_receipts": bool(row.false_receipt), "hung": row.outcome == HUNG, "ran_on": row.ran_on,
        "unlatched": row.unlatched, "disturbed": row.disturbed, "not_back": row.back_s is None,
    }  # fmt: skip
    return [name for name in BAD if holds.get(name)]


def measured(row: Row) -> bool:
    """Whether its time to stand-still depends on the system and the machine only, and not on a fault."""
    return row.in_order and row.covered


def _single(row: Row) -> bool:
    """Whether no more than one process was lost."""
    return "+" not in row.stop and row.how != How.POWER.value


def stops(tried: Sequence[Row]) -> list[dict[str, Any]]:
    """Time and travel to stand-still of machines in order, by machine and kind of stop."""
    found: dict[tuple[str, str, str], list[Row]] = {}
    for row in tried:
        if row.in_order and row.stood_s is not None:
            found.setdefault((row.machine, row.model, row.how), []).append(row)
    return [_line(*key, group) for key, group in sorted(found.items())]


def _line(machine: str, model: str, how: str, group: Sequence[Row]) -> dict[str, Any]:
    times = [row.stood_s for row in group if row.stood_s is not None]
    furthest = max(group, key=lambda row: row.travel_rad)
    return {
        "machine": machine, "model": model, "stop": how, "trials": len(group),
        "stood_p50_s": _rounded(percentile(times, 0.5)), "stood_max_s": _rounded(max(times)),
        "joint": furthest.travel_joint, "travel_max_rad": _rounded(furthest.travel_rad),
        "travel_max_m": _rounded(max(row.travel_m for row in group)),
    }  # fmt: skip


def _rounded(value: float | None) -> float | None:
    return None if value is None else round(value, 3)
