"""One line per event: `key=value` for people, or a JSON object for Loki, with process, run and goal.

A goal's worker thread binds `goal` and `run` (structlog.contextvars), so everything that it logs carries them; threads
that it starts do not.
"""

import logging
import queue
import re
import sys
from collections.abc import Sequence
from logging.handlers import QueueHandler, QueueListener
from typing import Any

import structlog
from prometheus_client import Counter
from structlog.typing import EventDict, Processor, WrappedLogger

from tms_decision.owner import parse
from tms_reason.reason import Reason
from tms_reason.texts import text
from tms_reason.wire import to_line

Logger = structlog.stdlib.BoundLogger

GOAL_ID = re.compile("[0-9a-f]{32}")
BREAKS = str.maketrans({"\n": "\\n", "\r": "\\r"})  # an event is one line, also if its text has line breaks
FIRST = ("process", "machine", "run", "goal", "event")  # keys in this order; the others follow in the caller's order
WAITING = 10_000  # lines at most that wait for a reader of stdout
LOST = Counter("tms_log_lines_lost_total", "Log lines that were not read in time")

_listeners: list["LogListener"] = []


class Queue(QueueHandler):
    """A thread that logs does not wait for the reader of stdout: a full pipe would block the stop of machines."""

    def enqueue(self, record: logging.LogRecord) -> None:
        """Take a finished line, or count that it was lost."""
        try:
            self.queue.put_nowait(record)
        except queue.Full:
            LOST.inc()


class LogListener(QueueListener):
    """Writes waiting lines to stdout."""

    def enqueue_sentinel(self) -> None:
        """Wait for room where the standard library would fail: waiting lines must still be written."""
        assert isinstance(self.queue, queue.Queue)
        self.queue.put(None)


def setup(process: str, machine: str | None = None, *, level: str = "INFO", as_json: bool = False) -> Logger:
    """Log to stdout, which supervisord keeps and rotates; returns the process's logger."""
    fields = {"process": process, **({"machine": machine} if machine else {})}
    lines: queue.Queue[logging.LogRecord] = queue.Queue(WAITING)
    handler = Queue(lines)
    handler.setFormatter(formatter(fields, as_json))
    logging.basicConfig(level=level, handlers=[handler], force=True)
    logging.captureWarnings(True)
    structlog.configure(
        processors=[structlog.stdlib.filter_by_level, structlog.stdlib.ProcessorFormatter.wrap_for_formatter],
        logger_factory=structlog.stdlib.LoggerFactory(),
        wrapper_class=Logger,
        cache_logger_on_first_use=True,
    )
    listener = LogListener(lines, logging.StreamHandler(sys.stdout))
    listener.start()
    _listeners.append(listener)
    logger: Logger = structlog.stdlib.get_logger(process)
    return logger


def close() -> None:
    """Write the waiting lines; this waits for a reader that does not read."""
    while _listeners:
        _listeners.pop().stop()


def formatter(fields: dict[str, str], as_json: bool) -> logging.Formatter:
    """The format of this process's lines, also for libraries that use the standard library's loggers."""

    def about(_logger: WrappedLogger, method: str, event: EventDict) -> EventDict:
        return {"level": method.upper(), **fields, **event}

    shared: Sequence[Processor] = (
        structlog.contextvars.merge_contextvars,
        about,
        _run_of_goal,
        _reasons,
        structlog.processors.TimeStamper(fmt="%Y-%m-%dT%H:%M:%S.%f", utc=False, key="time"),
        structlog.processors.ExceptionRenderer(),
    )
    renderer: Processor = structlog.processors.JSONRenderer(ensure_ascii=False, default=str) if as_json else line
    return structlog.stdlib.ProcessorFormatter(
        processors=[*shared, structlog.stdlib.ProcessorFormatter.remove_processors_meta, renderer]
    )


def _run_of_goal(_logger: WrappedLogger, _method: str, event: EventDict) -> EventDict:
    """Add the run that a goal belongs to, from the goal's id."""
    goal = event.get("goal")
    owner = parse(bytes.fromhex(goal)) if isinstance(goal, str) and GOAL_ID.fullmatch(goal) else None
    return event if owner is None else {**event, "run_number": owner.run}


def _reasons(_logger: WrappedLogger, _method: str, event: EventDict) -> EventDict:
    """A reason is logged as its code and arguments, for programs, and as its English text."""
    for key, value in list(event.items()):
        if isinstance(value, Reason):
            event[key], event[f"{key}_text"] = to_line(value), text(value, "en")
    return event


def line(_logger: WrappedLogger, _method: str, event: EventDict) -> str:
    """`2026-01-31T06:00:00.123456 INFO process=zx200:rc machine=zx200 goal=1f.. event=.. ..`, tracebacks last."""
    time, level = event.pop("time"), event.pop("level")
    trace = event.pop("exception", None)
    keys = [key for key in FIRST if key in event] + [key for key in event if key not in FIRST]
    words = [f"{key}={_shown(event[key])}" for key in keys]
    words += [] if trace is None else [f"trace={trace!r}"]
    return " ".join([time, level, *words]).translate(BREAKS)


def _shown(value: Any) -> str:
    text = str(value)
    return repr(text) if not text or any(sign in text for sign in " \"'=") else text
