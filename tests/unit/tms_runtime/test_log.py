"""Log lines: one each, with what is bound to process, run and goal; the same as JSON."""

import json
import logging
import os
import subprocess
import sys
import threading
from typing import Any

from structlog.contextvars import bind_contextvars

from tms_config.config import PROJECT
from tms_reason.reason import Foreign
from tms_runtime import log


def record(event: dict[str, Any]) -> logging.LogRecord:
    """As structlog hands it to the standard library."""
    found = logging.LogRecord("x", logging.INFO, __file__, 1, "", (), None)
    found.msg = event  # type: ignore[assignment]
    found._logger, found._name = logging.getLogger("x"), "info"  # type: ignore[attr-defined]
    return found


def in_thread(work: Any) -> Any:
    """Run in a thread of its own, as a goal's worker does; what it binds stays there."""
    found: list[Any] = []
    thread = threading.Thread(target=lambda: found.append(work()))
    thread.start()
    thread.join()
    return found[0]


FIELDS = {"process": "zx200:rc", "machine": "zx200"}
LINE, JSON = log.formatter(FIELDS, as_json=False), log.formatter(FIELDS, as_json=True)


def test_a_line_names_process_and_machine() -> None:
    assert LINE.format(record({"event": "started", "pid": 7})).split(" ", 1)[1] == (
        "INFO process=zx200:rc machine=zx200 event=started pid=7"
    )


def test_run_and_goal_are_on_every_line_of_their_thread_only() -> None:
    def work() -> str:
        bind_contextvars(run="r1")
        bind_contextvars(goal="g1")
        return LINE.format(record({"event": "moved"}))

    assert "run=r1 goal=g1 event=moved" in in_thread(work)
    assert "run=" not in LINE.format(record({"event": "moved"}))


def test_a_field_of_the_event_wins_over_a_bound_one() -> None:
    def work() -> str:
        bind_contextvars(goal="g1")
        return LINE.format(record({"event": "failed", "goal": "g2"}))

    assert in_thread(work).count("goal=") == 1 and "goal=g2" in in_thread(work)


def test_text_with_line_breaks_and_tracebacks_stay_on_one_line() -> None:
    try:
        raise ValueError("a\nb")
    except ValueError:
        for formatter in (LINE, JSON):
            broken = record({"event": "bug", "text": "first\nsecond", "exc_info": sys.exc_info()})
            shown = formatter.format(broken)
            assert "\n" not in shown and "first\\nsecond" in shown and "ValueError" in shown
    assert json.loads(shown)["exception"].splitlines()[0].startswith("Traceback")


def test_a_library_that_knows_only_the_standard_logger_is_told_the_same_way() -> None:
    plain = logging.LogRecord("x", logging.WARNING, __file__, 1, "disk %s", ("full",), None)
    assert LINE.format(plain).split(" ", 1)[1] == "WARNING process=zx200:rc machine=zx200 event='disk full'"
    assert json.loads(JSON.format(plain))["event"] == "disk full"


def test_json_keeps_the_types_of_values() -> None:
    row = json.loads(JSON.format(record({"event": "stop", "cause": "it's lost", "confirmed": True, "seconds": 0.25})))
    assert row["process"] == "zx200:rc" and row["machine"] == "zx200" and row["level"] == "INFO"
    assert (row["event"], row["cause"], row["confirmed"], row["seconds"]) == ("stop", "it's lost", True, 0.25)


def test_a_reason_is_told_to_programs_and_to_people() -> None:
    shown = LINE.format(record({"event": "refused", "reason": Foreign("no room")}))
    assert shown.endswith("""event=refused reason='FOREIGN words="no room"' reason_text='no room'""")


def test_nobody_who_logs_waits_for_a_reader_that_does_not_read() -> None:
    code = (
        "import sys\n"
        "from tms_runtime import log\n"
        "told = log.setup('zx200:rc')\n"
        "for number in range(20_000): told.info('spin', number=number)\n"
        "print('done', int(log.LOST._value.get()) > 0, file=sys.stderr, flush=True)\n"
        "sys.stdin.read()\n"
        "log.close()\n"
    )
    with subprocess.Popen(
        [sys.executable, "-c", code], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        env={**os.environ, "PYTHONPATH": str(PROJECT / "services")},
    ) as process:  # fmt: skip
        assert process.stderr is not None and process.stdin is not None and process.stdout is not None
        try:
            assert process.stderr.readline() == "done True\n"  # though nobody has read a line
            process.stdin.close()
            lines = process.stdout.read().splitlines()
        finally:
            process.kill()
    assert "event=spin number=0" in lines[0]
    assert log.WAITING < len(lines) < 20_000  # what waited is not lost with the process
