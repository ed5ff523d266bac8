"""Logs of several processes, merged by time. Pure logic.

A line begins with its time (tms_runtime/log.py), or is a JSON object with it. A line without one, such as a traceback
of a program that is not ours, belongs to the line before it and has that line's time.
"""

import json
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from datetime import datetime, timezone, tzinfo
from heapq import merge
from operator import attrgetter

from tms_ur.log_models import LogLine

BEGIN = re.compile(r"(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{6})(?: (DEBUG|INFO|WARNING|ERROR|CRITICAL))?(?: |$)")
EVER = datetime.min.replace(tzinfo=timezone.utc)
NEVER = datetime.max.replace(tzinfo=timezone.utc)


@dataclass(frozen=True)
class Span:
    """From when to when, both included."""

    begin: datetime = EVER
    end: datetime = NEVER


@dataclass(frozen=True)
class Merged:
    """The newest lines of all logs."""

    lines: list[LogLine]
    cut: bool  # older ones were left out


def parsed(process: str, text: str, zone: tzinfo | None = None) -> Iterator[LogLine]:
    """The lines of a log from its first one with a time on; `zone` is that of the times, None: of this PC."""
    at: datetime | None = None
    level = ""
    for line in filter(None, text.split("\n")):
        stamp, said, rest = _begin(line)
        told = None if stamp is None else _moment(stamp, zone)
        if told is not None:
            at, level = told, said
        if at is not None:
            yield LogLine(time=at, process=process, level=level, text=rest.removeprefix(f"process={process} "))


def merged(logs: Mapping[str, Iterable[LogLine]], span: Span, most: int) -> Merged:
    """The lines of a span of time by their times; of more than `most`, the newest."""
    inside = [[line for line in lines if span.begin <= line.time <= span.end] for lines in logs.values()]
    # a clock that was set back leaves a log whose times are not in order
    found = list(merge(*(sorted(lines, key=attrgetter("time")) for lines in inside), key=attrgetter("time")))
    return Merged(found[-most:], len(found) > most)


def _begin(line: str) -> tuple[str | None, str, str]:
    """Time, level and the rest of a line; None where it has no time."""
    if line.startswith("{"):
        return _of_json(line)
    found = BEGIN.match(line)
    return (None, "", line) if found is None else (found[1], found[2] or "", line[found.end() :])


def _of_json(line: str) -> tuple[str | None, str, str]:
    try:
        found = json.loads(line)
    except ValueError:
        return None, "", line
    stamp, level = found.get("time"), found.get("level", "")
    if not isinstance(stamp, str) or BEGIN.fullmatch(stamp) is None:
        return None, "", line
    rest = {key: value for key, value in found.items() if key not in ("time", "level")}
    return stamp, str(level), " ".join(f"{key}={value}" for key, value in rest.items())


def _moment(stamp: str, zone: tzinfo | None) -> datetime | None:
    """None for digits that are no time."""
    try:
        there = datetime.fromisoformat(stamp)
        return (there.astimezone() if zone is None else there.replace(tzinfo=zone)).astimezone(timezone.utc)
    except (ValueError, OverflowError):
        return None
