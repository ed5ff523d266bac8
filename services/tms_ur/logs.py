"""Endpoint of the logs of a machine's or a run's processes, merged by time; every role may call it."""

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from datetime import timedelta
from typing import TYPE_CHECKING, Annotated

import anyio
import anyio.to_thread
from fastapi import FastAPI, Query
from pydantic import AwareDatetime

from tms_config.config import Site
from tms_config.reasons import NoMachine
from tms_reason.errors import TmsError
from tms_ur.alarms import HOST_SILENT, SCHEDULER
from tms_ur.log_lines import EVER, Span, merged, parsed
from tms_ur.log_models import LogLine, Logs, MissingLog
from tms_ur.models import ActiveRun, Run
from tms_ur.problems import problems
from tms_ur.reason_view import of_error, view
from tms_ur.reasons import NoLogAsked, PcSilent, RunNotFound, UnknownProcess
from tms_ur.recordings import MACHINE, RUN

if TYPE_CHECKING:
    from tms_ur.site_client import SiteClient

SIZE = 200_000  # bytes of one log: a host agent gives some more at most
HISTORY = 1000  # runs in which an ended one is looked for
AROUND = timedelta(seconds=5)  # before and after a run: what led to it, and what it left
AWAY = ("NO_SERVER", "NO_ANSWER")  # codes of a host agent that does not answer: nor will it for the next process
NONE_YET = "LOG_UNREADABLE"  # code of a process that has never run
Moment = Annotated[AwareDatetime | None, Query(description="ISO 8601, or s since 1970")]


def add(app: FastAPI, client: "SiteClient", site: Site) -> None:
    """Add this endpoint to the application."""
    names = tuple(site.file.machines)
    few = anyio.CapacityLimiter(2)  # of its own: a PC that is away takes seconds, and a stop needs the other threads

    @app.get("/api/logs", summary="Log lines of the processes of a machine, or of all of a run, by their times",
             responses=problems(404, 409, 503))  # fmt: skip
    async def logs(
        machine: Annotated[str, Query(pattern=MACHINE, description="only its processes")] = "",
        run_id: Annotated[str, Query(pattern=RUN, description="its machines and the scheduler, while it ran")] = "",
        begin: Moment = None,
        end: Moment = None,
        limit: Annotated[int, Query(ge=1, le=10_000, description="lines at most, the newest")] = 2000,
    ) -> Logs:
        if not machine and not run_id:
            raise TmsError(NoLogAsked())
        if machine and machine not in names:
            raise TmsError(NoMachine(machine, names))

        def read() -> Logs:
            groups, span = ([machine], Span()) if not run_id else _of_run(_run(client, run_id), machine)
            span = replace(span, begin=begin or span.begin, end=end or span.end)
            return _told(_collected(client, groups, [SCHEDULER] if run_id and not machine else []), span, limit)

        return await anyio.to_thread.run_sync(read, limiter=few)


def _run(client: "SiteClient", run_id: str) -> Run | ActiveRun:
    found = next((run for run in client.board.snapshot().runs if run.run_id == run_id), None)
    if found is not None:
        return found
    ended = next((run for run in client.runs(HISTORY) if run.run_id == run_id), None)
    if ended is None:
        raise TmsError(RunNotFound(run_id))
    return ended


def _of_run(run: Run | ActiveRun, machine: str) -> tuple[list[str], Span]:
    """The machines of a run, or the one that was asked for, and the time of the run."""
    ended = run.ended_at if isinstance(run, Run) else None
    span = Span(begin=EVER if run.started_at is None else run.started_at - AROUND)
    return [machine] if machine else list(run.machines), span if ended is None else replace(span, end=ended + AROUND)


@dataclass
class Collected:
    """What host agents gave."""

    texts: dict[str, str] = field(default_factory=dict)  # by process
    missing: dict[str, MissingLog] = field(default_factory=dict)


def _collected(client: "SiteClient", groups: Iterable[str], more: Iterable[str]) -> Collected:
    """The logs of all processes of some groups, and of some more. A PC that is away costs one call at most."""
    found, wanted, groups = Collected(), set(more), set(groups)
    known: set[str] = set()
    for host in client.board.snapshot().hosts:
        why = view(PcSilent(host.name)) if host.age > HOST_SILENT else None
        for name in (row.name for row in host.processes):
            if name.partition(":")[0] not in groups and name not in wanted:
                continue
            known.add(name)
            if why is not None:
                found.missing[name] = MissingLog(process=name, reason=why)
                continue
            try:
                found.texts[name] = client.log(name, SIZE)
            except TmsError as error:
                if error.code != NONE_YET:
                    found.missing[name] = MissingLog(process=name, reason=of_error(error))
                why = of_error(error) if error.code in AWAY else None
    for name in sorted({*wanted, *(f"{group}:rc" for group in groups)} - known):
        found.missing[name] = MissingLog(process=name, reason=view(UnknownProcess(name)))
    return found


def _told(found: Collected, span: Span, limit: int) -> Logs:
    lines: dict[str, list[LogLine]] = {name: list(parsed(name, text)) for name, text in found.texts.items()}
    result = merged(lines, span, limit)
    short = [name for name in lines if _short(found.texts[name], lines[name], span)]
    missing = [found.missing[name] for name in sorted(found.missing)]
    return Logs(lines=result.lines, cut=result.cut, short=short, missing=missing)


def _short(text: str, lines: list[LogLine], span: Span) -> bool:
    """Whether a log was longer than what was read of it, and older lines were asked for."""
    first = max(len(line.encode()) for line in text.split("\n"))  # the line that was cut is as long at most, as a rule
    whole = len(text.encode()) + first < SIZE
    return not whole and span.begin != EVER and (not lines or lines[0].time > span.begin)
