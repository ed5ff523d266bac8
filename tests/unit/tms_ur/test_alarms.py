"""Alarms on the board: the rules of Prometheus, for as long as they must hold, of what tms:ur knows."""

import re
from dataclasses import dataclass, field
from datetime import timedelta
from typing import Any

import pytest
import yaml

from conftest import PROJECT
from tms_config.clock import utc_now
from tms_decision.reasons import SoftwareStop
from tms_rc.reasons import Rival
from tms_ur.alarms import NOT_SEEN_HERE, RULES, WINDOW
from tms_ur.board import Board
from tms_ur.models import Host, LastStop, Machine, Process
from tms_ur.reason_view import view
from tms_ur.recent import MOST

SECONDS = {"s": 1, "m": 60, "h": 3600}
FILE = PROJECT / "deploy" / "prometheus" / "rules.yml"
ALERTS = {
    rule["alert"]: rule
    for group in yaml.safe_load(FILE.read_text(encoding="utf-8"))["groups"]
    for rule in group["rules"]
    if "alert" in rule
}
WHY = view(SoftwareStop())


def seconds(words: str) -> int:
    return int(words[:-1]) * SECONDS[words[-1]]


def numbers(expression: str) -> tuple[float, ...]:
    """Windows and limits in their order; what a gauge of 0 or 1 is compared with is no limit."""
    found = re.findall(r"\[(\d+[smh])\]|(?<![=!])[<>]=? (\d+(?:\.\d+)?)", re.sub(r"\{[^}]*\}", "", expression))
    return tuple(seconds(window) if window else float(limit) for window, limit in found)


def test_every_alert_of_prometheus_is_judged_or_said_not_to_be() -> None:
    judged = [rule.name for rule in RULES]
    assert not set(judged) & set(NOT_SEEN_HERE)
    assert sorted([*judged, *NOT_SEEN_HERE]) == sorted(ALERTS)
    assert all(NOT_SEEN_HERE.values())


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.name)
def test_durations_severities_and_numbers_are_those_of_prometheus(rule: Any) -> None:
    alert = ALERTS[rule.name]
    assert rule.lasts == seconds(alert.get("for", "0s"))
    assert rule.severity == alert["labels"]["severity"]
    assert rule.numbers == numbers(alert["expr"])


def test_no_rule_asks_for_more_events_than_are_remembered() -> None:
    assert all(number < MOST or number == WINDOW for rule in RULES for number in rule.numbers)


@dataclass
class Site:
    """A board of which everything is well, with a clock that the test turns and tells of all the time."""

    now: float = 100.0
    machine: dict[str, Any] = field(default_factory=dict)
    rows: list[Process] = field(default_factory=lambda: [Process(name="tms:ts", state="RUNNING")])
    inputs: dict[str, str] = field(default_factory=dict)
    deaf: set[str] = field(default_factory=set)  # what tells nothing

    def __post_init__(self) -> None:
        self.board = Board(["zx200"], lambda: self.now)
        self.tell()

    def tell(self) -> None:
        if "zx200" not in self.deaf:
            self.board.put_machine(Machine(**{"name": "zx200", "state": "standing", "joint_age": 0.1, **self.machine}))
        if "tms:ts" not in self.deaf:
            self.board.put_runs([])
        if "pc" not in self.deaf:
            self.board.put_host(Host(name="pc", processes=self.rows))
        if "tms:sp" not in self.deaf and self.inputs:
            self.board.put_inputs(self.inputs)

    def after(self, seconds: float) -> list[tuple[str, str]]:
        """The alarms when so much time has passed."""
        end = self.now + seconds
        self.board.snapshot()
        while self.now < end:
            self.now = min(end, self.now + 0.5)
            self.tell()
            self.board.snapshot()
        return [(alarm.name, alarm.subject) for alarm in self.board.snapshot().alarms]


def test_a_site_that_is_well_has_no_alarms() -> None:
    rows = [Process(name="tms:discovery", state="RUNNING"), Process(name="zx200:st", state="STOPPED", on_demand=True)]
    assert Site(rows=rows, inputs={"pile": "alive", "rain": "waiting"}).after(700) == []


@pytest.mark.parametrize(
    ("facts", "lasts", "name"),
    [
        ({"latch": WHY}, 600, "TmsLatchHeld"),
        ({"joint_age": 1.1}, 15, "TmsMachineSilent"),
        ({"joint_age": None}, 15, "TmsMachineSilent"),
    ],
)
def test_a_machine_is_an_alarm_after_its_time(facts: dict[str, Any], lasts: float, name: str) -> None:
    site = Site(machine=facts)
    assert site.after(lasts - 0.5) == []
    assert site.after(0.5) == [(name, "zx200")]
    site.machine = {}
    assert site.after(0.5) == []
    site.machine = facts
    assert site.after(lasts - 1) == [], "what begins anew must last anew"


def test_a_gateway_that_cannot_work() -> None:
    site = Site(machine={"state": "not_ready", "reason": WHY})
    assert site.after(59.5) == []
    assert site.after(0.5) == [("TmsNotReady", "zx200:rc")]
    site.machine = {"state": "not_ready", "reason": view(Rival("zx200", "pid 7 on pc2"))}
    assert site.after(0.5) == [("TmsTwoGateways", "zx200"), ("TmsNotReady", "zx200:rc")], "the critical first"


def test_a_stop_that_was_not_confirmed_is_told_for_ten_minutes() -> None:
    site = Site()
    site.board.put_stop("zx200", LastStop(stamp=utc_now() - timedelta(seconds=590), confirmed=False))
    site.board.put_stop("zx200", LastStop(stamp=utc_now(), confirmed=True))
    assert site.after(5) == [("TmsStopUnconfirmed", "zx200")]
    assert site.after(10) == []


def test_a_lost_gateway_is_told_while_it_is_lost_and_ten_minutes_longer() -> None:
    site = Site()
    site.board.put_standing_in("zx200", False)
    assert site.after(0) == []
    site.board.put_standing_in("zx200", True)
    assert site.after(700) == [("TmsGatewayLost", "zx200")]
    site.board.put_standing_in("zx200", False)
    assert site.after(0) == []
    site.board.put_standing_in("zx200", True)
    site.board.put_standing_in("zx200", False)
    assert site.after(599) == [("TmsGatewayLost", "zx200")]
    assert site.after(1) == []


@pytest.mark.parametrize(("deaf", "found"), [("zx200", "zx200:rc"), ("tms:ts", "tms:ts"), ("pc", "pc")])
def test_what_says_nothing_is_away(deaf: str, found: str) -> None:
    site = Site()
    site.deaf = {deaf}
    assert site.after(14) == []
    assert site.after(10) == [("TmsProcessDown", found)]


def test_of_a_silent_pc_only_that_is_told() -> None:
    rows = [Process(name=name, state="RUNNING") for name in ("tms:ts", "zx200:rc", "tms:discovery")]
    site = Site(rows=rows)
    site.deaf = {"pc", "tms:ts", "zx200"}
    assert site.after(60) == [("TmsProcessDown", "pc")]


@pytest.mark.parametrize("state", ["STOPPED", "EXITED", "BACKOFF", "STARTING"])
def test_an_essential_process_runs(state: str) -> None:
    rows = [Process(name="tms:db", state=state), Process(name="zx200:st", state=state, on_demand=True)]
    site = Site(rows=rows)
    assert site.after(14.5) == []
    assert site.after(0.5) == [("TmsProcessDown", "tms:db")]
    assert site.board.snapshot().alarms[0].reason.action is not None


def test_the_discovery_server_has_a_rule_of_its_own() -> None:
    site = Site(rows=[Process(name="tms:discovery", state="STOPPED")])
    assert site.after(9.5) == []
    assert site.after(20) == [("TmsDiscoveryDown", "tms:discovery")]


def test_a_process_that_supervisord_has_given_up_is_told_at_once() -> None:
    assert Site(rows=[Process(name="zx200:st", state="FATAL", on_demand=True)]).after(0) == [
        ("TmsCrashLoop", "zx200:st")
    ]


def test_a_process_that_ends_again_and_again_within_ten_minutes() -> None:
    site = Site(rows=[Process(name="zx200:st", state="RUNNING", restarts=7)])
    site.after(1)
    for restarts, found in ((8, []), (10, [("TmsCrashLoop", "zx200:st")])):
        site.rows = [Process(name="zx200:st", state="RUNNING", restarts=restarts)]
        assert site.after(1) == found
    site.rows = [Process(name="zx200:st", state="RUNNING", restarts=0)]  # the host agent has begun anew
    assert site.after(590) == [("TmsCrashLoop", "zx200:st")]
    assert site.after(20) == []


@pytest.mark.parametrize(
    ("state", "lasts", "name"), [("silent", 5, "TmsSensingStale"), ("clock", 30, "TmsSensingClock")]
)
def test_an_input_of_sensing(state: str, lasts: float, name: str) -> None:
    site = Site(inputs={"pile": state, "rain": "alive"})
    assert site.after(lasts - 0.5) == []
    assert site.after(0.5) == [(name, "pile")]
    site.deaf = {"tms:sp"}
    assert site.after(5) == [], "what tms:sp does not tell any more is no alarm: that it is away is one"


def test_an_alarm_says_since_when_and_is_made_once() -> None:
    site = Site(rows=[Process(name="tms:db", state="STOPPED")])
    begun = site.board.snapshot().time
    site.after(15)
    (first,) = site.board.snapshot().alarms
    assert first.since == begun
    assert site.board.snapshot().alarms[0] is first
