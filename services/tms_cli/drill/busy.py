"""Finds in the logs whether this PC did not run a machine's processes for a moment.

Evidence is only the time that the kernel counts as waiting for a processor: a long callback is no fault of the PC.
"""

import re
from collections.abc import Iterable
from datetime import datetime

from tms_config.config import Site
from tms_config.processes import table
from tms_host.supervisor import log_file

BEFORE, AFTER = 1.5, 2.0  # s around the begin of a stop: the length of a lease, and the delay of a line in the log
LINE = re.compile(r"^(\S+) \w+ process=(\S+) .*event=stood_still seconds=(\S+) waited=(\S+)")


def stood_still(site: Site, machine: str, stops: Iterable[float]) -> str:
    """The process that did not run around the begin of a stop (s since 1970); empty if all ran."""
    names = [row.full for row in table(site) if row.group == machine or row.full == "tms:ts"]
    lines = [line for name in names for line in _lines(site, name)]
    return next((reported for at in stops for line in lines if (reported := _near(line, at))), "")


def _lines(site: Site, name: str) -> list[str]:
    path = log_file(site, name)
    return path.read_text(encoding="utf-8", errors="replace").splitlines() if path.exists() else []


def _near(line: str, at: float) -> str:
    found = LINE.match(line)
    if found is None:
        return ""
    written, process, *numbers = found.groups()
    ended, (silent, waited) = datetime.fromisoformat(written).timestamp(), map(float, numbers)
    near = -BEFORE < ended - at < AFTER and waited > silent / 2
    return f"this PC did not run {process} for {waited:.1f} of {silent:.1f} s" if near else ""
