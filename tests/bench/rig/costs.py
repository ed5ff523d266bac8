"""What a process tells of its work, and what it weighs."""

from __future__ import annotations

import urllib.request

import psutil
from prometheus_client.parser import text_string_to_metric_families

from tms_config.processes import Process


def counted(row: Process) -> dict[str, float]:
    """Its metrics, by name and labels: `tms_ts_tick_seconds_bucket_0.25`."""
    with urllib.request.urlopen(f"http://{row.address}:{row.port}/metrics", timeout=5) as answer:
        families = text_string_to_metric_families(answer.read().decode())
        return {
            "_".join((sample.name, *sample.labels.values())): sample.value
            for family in families
            for sample in family.samples
        }


def pss(pid: int) -> float:
    """MB of a process; what it shares counts for its part."""
    return float(psutil.Process(pid).memory_full_info().pss) / 1e6
