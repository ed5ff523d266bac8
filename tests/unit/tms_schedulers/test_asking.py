"""Which of several schedulers answers."""

import threading
from typing import Any

import pytest

from tms_reason.errors import RosError, TmsError
from tms_reason.reason import Foreign
from tms_ros.reasons import NoServer
from tms_schedulers import asking, names
from tms_schedulers.names import Scheduler
from tms_schedulers.reasons import OtherScheduler

MAIN, EAST = Scheduler("tms:ts", frozenset({"zx200"})), Scheduler("tms:ts_e", frozenset({"ic120"}), "/tms/ts_e")
UNKNOWN = TmsError(Foreign("no run"), "NO_RUN")
AWAY = RosError(NoServer("tms:ts", "/tms/execute_task", 1.0))
REFUSED = TmsError(Foreign("latched"), "NOT_ARMED")
SITE: Any = None


@pytest.fixture(autouse=True)
def two(monkeypatch: pytest.MonkeyPatch) -> None:
    for module in (asking, names):
        monkeypatch.setattr(module, "schedulers", lambda _: (MAIN, EAST))


def said(**answers: Any) -> Any:
    """What each scheduler says, by the end of its name."""

    def ask(one: Scheduler) -> Any:
        answer = answers[one.process[4:]]
        if isinstance(answer, TmsError):
            raise answer
        return answer

    return ask


@pytest.mark.parametrize(
    ("main", "east", "found"),
    [("x", UNKNOWN, "x"), (UNKNOWN, "y", "y"), (AWAY, "y", "y"), (UNKNOWN, REFUSED, REFUSED), (AWAY, UNKNOWN, AWAY),
     (AWAY, REFUSED, REFUSED), (UNKNOWN, UNKNOWN, UNKNOWN)],
)  # fmt: skip
def test_the_one_that_knows_it(main: Any, east: Any, found: Any) -> None:
    ask = said(ts=main, ts_e=east)
    if isinstance(found, TmsError):
        with pytest.raises(TmsError) as caught:
            asking.of_any(SITE, ask, "NO_RUN")
        assert caught.value is found
    else:
        assert asking.of_any(SITE, ask, "NO_RUN") == found


def test_nobody_waits_for_one_that_is_slow_to_be_asked() -> None:
    asked = threading.Barrier(2, timeout=10.0)  # s, to bound a failure
    answers, refusals = asking.of_all(SITE, lambda one: (asked.wait(), one.process)[1])
    assert sorted(answers) == ["tms:ts", "tms:ts_e"] and refusals == []


def test_the_first_that_is_there() -> None:
    assert asking.of_first(SITE, said(ts="x", ts_e="y")) == "x"
    assert asking.of_first(SITE, said(ts=AWAY, ts_e="y")) == "y"
    with pytest.raises(TmsError, match="latched"):
        asking.of_first(SITE, said(ts=REFUSED, ts_e="y"))


def test_a_task_goes_to_the_scheduler_that_the_first_one_names() -> None:
    other = TmsError(OtherScheduler("tms:ts_e", ("ic120",)))
    assert asking.of_its_own(SITE, said(ts=other, ts_e="run"), "NO_RUN") == "run"
    with pytest.raises(TmsError) as caught:
        asking.of_its_own(SITE, said(ts=other, ts_e=REFUSED), "NO_RUN")
    assert caught.value is REFUSED


def test_without_the_first_one_the_next_takes_it() -> None:
    assert asking.of_its_own(SITE, said(ts=AWAY, ts_e="run"), "NO_RUN") == "run"
    assert asking.of_its_own(SITE, said(ts=UNKNOWN, ts_e="resumed"), "NO_RUN") == "resumed"
    with pytest.raises(TmsError) as caught:
        asking.of_its_own(SITE, said(ts=REFUSED, ts_e="run"), "NO_RUN")
    assert caught.value is REFUSED
