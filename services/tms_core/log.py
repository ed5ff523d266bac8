"""One line per event: `key=value` for people, or a JSON object for Loki; the process, run and goal are bound to it.

A goal's worker thread calls `bind`, so everything that it logs carries the ids; threads that it starts do not.
"""

import contextvars
import json
import logging
import queue
import re
import sys
from logging.handlers import QueueHandler, QueueListener
from typing import Any

from prometheus_client import Counter

FIELD = re.compile(r"(?<!\S)([a-z_]+)=('(?:[^'\\]|\\.)*'|\"(?:[^\"\\]|\\.)*\"|\S+)")
BREAKS = str.maketrans({"\n": "\\n", "\r": "\\r"})  # an event is one line, whatever its text holds

WAITING = 10_000  # lines at most that wait for a reader of stdout
LOST = Counter("tms_log_lines_lost_total", "Log lines that nobody read in time")

_listeners: list["Listener"] = []
_bound: contextvars.ContextVar[dict[str, str]] = contextvars.ContextVar("bound")


def bind(**fields: str) -> None:
    """Add fields (run, goal) to everything that this thread logs from now on."""
    _bound.set({**_bound.get({}), **fields})


class Line(logging.Formatter):
    """`2026-01-31T06:00:00.123 INFO process=zx200:rc machine=zx200 goal=1f.. event=.. ..`; tracebacks in `trace=`."""

    def __init__(self, fields: dict[str, str]) -> None:
        super().__init__(datefmt="%Y-%m-%dT%H:%M:%S")
        self._fields = fields

    def format(self, record: logging.LogRecord) -> str:
        """The record on one line."""
        time, level = f"{self.formatTime(record, self.datefmt)}.{int(record.msecs):03d}", record.levelname
        message = record.getMessage()
        fields = {key: value for key, value in self.fields().items() if f"{key}=" not in message}
        words = [time, level, *(f"{key}={value}" for key, value in fields.items()), message]
        if record.exc_info:
            words.append(f"trace={self.formatException(record.exc_info)!r}")
        return " ".join(words).translate(BREAKS)

    def fields(self) -> dict[str, str]:
        """What is bound to the process and to this thread."""
        return {**self._fields, **_bound.get({})}


class Json(Line):
    """The same as a JSON object; `key=value` words of the message become keys, the text stays as `message`."""

    def format(self, record: logging.LogRecord) -> str:
        """The record as one JSON object."""
        message = record.getMessage()
        row: dict[str, Any] = {
            "time": f"{self.formatTime(record, self.datefmt)}.{int(record.msecs):03d}",
            "level": record.levelname,
            **self.fields(),
        }
        row.update({key: _plain(value) for key, value in FIELD.findall(message) if key not in ("time", "level")})
        row["message"] = message
        if record.exc_info:
            row["trace"] = self.formatException(record.exc_info)
        return json.dumps(row, ensure_ascii=False)


class Queue(QueueHandler):
    """Nobody who logs waits for whoever reads: a full pipe would stand still with everything that stops machines."""

    def enqueue(self, record: logging.LogRecord) -> None:
        """Take a finished line, or count that it was lost."""
        try:
            self.queue.put_nowait(record)
        except queue.Full:
            LOST.inc()


class Listener(QueueListener):
    """Writes what waits to stdout."""

    def enqueue_sentinel(self) -> None:
        """Wait for room where the standard library would fail: what waits is still to be written."""
        assert isinstance(self.queue, queue.Queue)
        self.queue.put(None)


def setup(process: str, machine: str | None = None, *, level: str = "INFO", as_json: bool = False) -> logging.Logger:
    """Send everything to stdout, which supervisord keeps and rotates; returns the process's logger."""
    fields = {"process": process, **({"machine": machine} if machine else {})}
    lines: queue.Queue[logging.LogRecord] = queue.Queue(WAITING)
    handler = Queue(lines)
    handler.setFormatter(Json(fields) if as_json else Line(fields))
    logging.basicConfig(level=level, handlers=[handler], force=True)
    logging.captureWarnings(True)
    listener = Listener(lines, logging.StreamHandler(sys.stdout))
    listener.start()
    _listeners.append(listener)
    return logging.getLogger(process)


def close() -> None:
    """Write what waits; a reader that does not read is waited for."""
    while _listeners:
        _listeners.pop().stop()


def _plain(value: str) -> str:
    return value[1:-1] if len(value) > 1 and value[0] == value[-1] and value[0] in "'\"" else value
