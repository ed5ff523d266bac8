"""Log lines: one each, with what is bound to process, run and goal; the same as JSON."""

import json
import logging
import os
import subprocess
import sys
import threading
from typing import Any

from tms_core import log
from tms_core.config import PROJECT


def record(message: str, *words: object, error: BaseException | None = None) -> logging.LogRecord:
    info: Any = (type(error), error, None) if error is not None else None
    return logging.LogRecord("x", logging.INFO, __file__, 1, message, words, info)


def in_thread(work: Any) -> Any:
    """Run in a thread of its own, as a goal's worker does; what it binds stays there."""
    found: list[Any] = []
    thread = threading.Thread(target=lambda: found.append(work()))
    thread.start()
    thread.join()
    return found[0]


LINE = log.Line({"process": "zx200:rc", "machine": "zx200"})
JSON = log.Json({"process": "zx200:rc", "machine": "zx200"})


def test_a_line_names_process_and_machine() -> None:
    assert LINE.format(record("event=started pid=%d", 7)).split(" ", 1)[1] == (
        "INFO process=zx200:rc machine=zx200 event=started pid=7"
    )


def test_run_and_goal_are_on_every_line_of_their_thread_only() -> None:
    def work() -> str:
        log.bind(run="r1")
        log.bind(goal="g1")
        return LINE.format(record("event=moved"))

    assert "run=r1 goal=g1 event=moved" in in_thread(work)
    assert "run=" not in LINE.format(record("event=moved"))


def test_a_field_of_the_message_is_not_told_twice() -> None:
    def work() -> str:
        log.bind(goal="g1")
        return LINE.format(record("event=failed goal=g1"))

    assert in_thread(work).count("goal=g1") == 1


def test_text_with_line_breaks_and_tracebacks_stay_on_one_line() -> None:
    try:
        raise ValueError("a\nb")
    except ValueError:
        broken = record("event=bug first\nsecond")
        broken.exc_info = sys.exc_info()
    for formatter in (LINE, JSON):
        assert "\n" not in formatter.format(broken)
    assert "first\\nsecond" in LINE.format(broken) and "ValueError" in LINE.format(broken)
    assert json.loads(JSON.format(broken))["trace"].splitlines()[0].startswith("Traceback")


def test_json_has_the_words_of_the_message_as_keys() -> None:
    row = json.loads(JSON.format(record("event=stop cause=%r confirmed=%s seconds=%.3f 停止", "it's lost", True, 0.25)))
    assert row["process"] == "zx200:rc" and row["machine"] == "zx200" and row["level"] == "INFO"
    assert (row["event"], row["cause"], row["confirmed"], row["seconds"]) == ("stop", "it's lost", "True", "0.250")
    assert "停止" in row["message"]


def test_a_message_cannot_fake_level_or_time() -> None:
    row = json.loads(JSON.format(record("level=CRITICAL time=never")))
    assert row["level"] == "INFO" and row["time"] != "never"


def test_nobody_who_logs_waits_for_a_reader_that_does_not_read() -> None:
    code = (
        "import sys\n"
        "from tms_core import log\n"
        "told = log.setup('zx200:rc')\n"
        "for number in range(20_000): told.info('event=spin number=%d', number)\n"
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
