"""Logs of a machine and of a run, over the API."""

from dataclasses import dataclass, field
from datetime import timedelta
from typing import Any

import pytest

from tms_reason.errors import TmsError
from tms_reason.reason import Foreign
from tms_ur.board import Board
from tms_ur.logs import HOST_SILENT, SIZE
from tms_ur.models import ActiveRun, Host, Process
from unit.tms_ur.fakes import NOON, Client, FakeSiteClient, app

NAMES = {"near": ["zx200:rc", "zx200:st", "tms:ts", "tms:db"], "far": ["zx200:mc", "ic120:rc"]}


def line(seconds: float, text: str, level: str = "INFO") -> str:
    there = (NOON + timedelta(seconds=seconds)).astimezone().replace(tzinfo=None)
    return f"{there.isoformat(timespec='microseconds')} {level} {text}\n"


@dataclass
class Site(FakeSiteClient):
    texts: dict[str, str | TmsError] = field(default_factory=dict)
    now: float = 100.0

    def __post_init__(self) -> None:
        super().__init__()
        self.board = Board(["zx200"], lambda: self.now)
        for host, names in NAMES.items():
            self.board.put_host(Host(name=host, processes=[Process(name=name, state="RUNNING") for name in names]))

    def log(self, process: str, size: int) -> str:
        super().log(process, size)
        text = self.texts.get(process, "")
        if isinstance(text, TmsError):
            raise text
        return text


def asked(site: Site, query: str) -> Any:
    answer = Client(app(site)).get(f"/api/logs?{query}")
    return answer.json() if answer.status_code == 200 else (answer.status_code, answer.json()["code"])


def read(site: Site) -> set[object]:
    return {call[1] for call in site.calls if call[0] == "log"}


def test_the_processes_of_a_machine() -> None:
    site = Site({"zx200:rc": line(1, "event=a") + line(3, "event=c", "ERROR"), "zx200:mc": line(2, "event=b")})
    told = asked(site, "machine=zx200")
    assert [(one["process"], one["level"], one["text"]) for one in told["lines"]] == [
        ("zx200:rc", "INFO", "event=a"), ("zx200:mc", "INFO", "event=b"), ("zx200:rc", "ERROR", "event=c"),
    ]  # fmt: skip
    assert told["lines"][0]["time"] == "2026-01-31T12:00:01Z"
    assert (told["cut"], told["short"], told["missing"]) == (False, [], [])
    assert read(site) == {"zx200:rc", "zx200:st", "zx200:mc"}
    assert [one["text"] for one in asked(site, "machine=zx200&limit=1")["lines"]] == ["event=c"]


@pytest.mark.parametrize(
    ("begin", "end"), [("2026-01-31T12:00:02Z", "2026-01-31T21:00:02%2B09:00"), (NOON.timestamp() + 2,) * 2]
)
def test_from_when_to_when(begin: object, end: object) -> None:
    site = Site({"zx200:rc": line(1, "event=a") + line(2, "event=b") + line(3, "event=c")})
    told = asked(site, f"machine=zx200&begin={begin}&end={end}")
    assert [one["text"] for one in told["lines"]] == ["event=b"]


def test_a_run_has_the_logs_of_its_machines_and_of_the_scheduler_while_it_ran() -> None:
    text = line(-6, "event=before") + line(0, "event=begun") + line(6, "event=after")
    site = Site({"zx200:rc": text, "tms:ts": text})  # the run of the history begins and ends at noon
    assert [(one["process"], one["text"]) for one in asked(site, "run_id=r-1")["lines"]] == [
        ("zx200:rc", "event=begun"), ("tms:ts", "event=begun"),
    ]  # fmt: skip
    assert read(site) == {"zx200:rc", "zx200:st", "zx200:mc", "tms:ts"}


def test_a_run_that_goes_on() -> None:
    site = Site({"ic120:rc": line(0, "event=begun") + line(60, "event=late")})
    site.board.put_runs(
        [ActiveRun(run_id="r-2", task_id=4, state="running", machines=["zx200", "ic120"], started_at=NOON)]
    )
    assert [one["text"] for one in asked(site, "run_id=r-2")["lines"]] == ["event=begun", "event=late"]
    asked(site, "run_id=r-2&machine=zx200")
    assert {call for call in site.calls if call[0] == "runs"} == set(), "no run of the history was needed"


def test_a_pc_that_is_away_is_named_and_not_asked() -> None:
    site = Site({"zx200:rc": line(1, "event=a")})
    site.now += HOST_SILENT + 0.1
    site.board.put_host(Host(name="near", processes=[Process(name="zx200:rc", state="RUNNING")]))
    told = asked(site, "machine=zx200")
    assert [one["text"] for one in told["lines"]] == ["event=a"]
    assert [(one["process"], one["reason"]["code"]) for one in told["missing"]] == [("zx200:mc", "PC_SILENT")]
    assert read(site) == {"zx200:rc"}


def test_a_pc_that_does_not_answer_costs_one_call() -> None:
    away = TmsError(Foreign("no answer"), "NO_ANSWER")
    site = Site({"zx200:rc": away, "zx200:mc": line(1, "event=a")})
    told = asked(site, "machine=zx200")
    assert [one["text"] for one in told["lines"]] == ["event=a"]
    assert [one["process"] for one in told["missing"]] == ["zx200:rc", "zx200:st"]
    assert read(site) == {"zx200:rc", "zx200:mc"}


def test_a_process_that_never_ran_has_no_log_and_is_no_fault() -> None:
    site = Site({"zx200:st": TmsError(Foreign("no file"), "LOG_UNREADABLE"), "zx200:rc": line(1, "event=a")})
    told = asked(site, "machine=zx200")
    assert len(told["lines"]) == 1 and told["missing"] == []


def test_a_machine_whose_pc_was_never_heard_is_named() -> None:
    site = Site()
    site.board = Board(["zx200"])
    assert [one["process"] for one in asked(site, "machine=zx200")["missing"]] == ["zx200:rc"]


def test_a_log_of_which_the_asked_time_is_gone_is_named() -> None:
    long = "".join(line(n, "event=" + "x" * 1000) for n in range(SIZE // 1000))[-SIZE:]
    site = Site({"zx200:rc": long, "zx200:mc": line(1, "event=a")})
    assert asked(site, f"machine=zx200&begin={NOON.timestamp()}")["short"] == ["zx200:rc"]
    assert asked(site, f"machine=zx200&begin={NOON.timestamp() + 100}")["short"] == []


@pytest.mark.parametrize(
    ("query", "answer"),
    [
        ("", (409, "NO_LOG_ASKED")),
        ("machine=dozer", (404, "NO_MACHINE")),
        ("run_id=r-77", (404, "RUN_NOT_FOUND")),
        ("machine=zx200&begin=2026-01-31T12:00:00", (422, "BAD_REQUEST")),
    ],
)
def test_what_cannot_be_told(query: str, answer: tuple[int, str]) -> None:
    assert asked(Site(), query) == answer
