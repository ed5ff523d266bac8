"""What is kept of a trial for the model of the protocol."""

import json
from pathlib import Path

from tms_cli.drill.history import CLOCKS, Happening, Hit, happenings, keep
from tms_cli.drill.plan import NONE, STOPS, Trial
from tms_cli.drill.record import Goal, Receipt, TrialRecording

HIT = 1000.0  # s since 1970
RECORD = TrialRecording(
    receipts=[Receipt(HIT + 0.5, 2.0, True, "", "", HIT + 2.7), Receipt(HIT + 4.0, 10.0, False, "", "", HIT + 14.1)],
    goals={b"1": Goal(HIT - 1.0)},
)
RUN = [(HIT - 2.0, "STATE_RUNNING"), (HIT + 3.0, "STATE_FAILURE")]


def told(stop: str, hit: Hit) -> list[Happening]:
    return sorted(happenings(Trial("zx200", STOPS[stop], NONE, 0.0, 1.0), RECORD, hit, RUN), key=lambda one: one.likely)


def test_each_thing_lies_between_two_times() -> None:
    found = told("kill rc", Hit(HIT, ("zx200:rc",), {"zx200:rc": HIT + 1.2}, HIT + 2.0))
    assert [(one.what, one.who, one.told) for one in found] == [
        ("run", "tms:ts", "STATE_RUNNING"), ("accepts", "zx200", ""), ("killed", "zx200:rc", ""),
        ("started", "zx200:rc", ""), ("receipt", "zx200", "confirmed"), ("run", "tms:ts", "STATE_FAILURE"),
        ("receipt", "zx200", "unconfirmed"),
    ]  # fmt: skip
    started, receipt = found[3], found[4]
    assert (started.first, started.last) == (HIT, HIT + 2.0)  # between the kill and its first sign of work
    assert (receipt.first, receipt.last) == (HIT + 2.5, HIT + 2.7)  # between the proof and its arrival
    assert all(one.first <= one.likely <= one.last for one in found)


def test_a_frozen_process_does_not_start_again_and_a_press_needs_a_moment() -> None:
    frozen = told("freeze tms:ts", Hit(HIT, ("tms:ts",), {"tms:ts": HIT + 2.0}, HIT + 2.0))
    assert [one.what for one in frozen if one.who == "tms:ts"] == ["run", "frozen", "run"]
    pressed = [one for one in told("software stop", Hit(HIT, (), {}, HIT)) if one.what == "pressed"]
    assert pressed[0].first == HIT and pressed[0].last > HIT + CLOCKS


def test_trials_are_lines_of_a_file(tmp_path: Path) -> None:
    trial = Trial("zx200", STOPS["cancel"], NONE, 0.0, 1.0)
    for _ in range(2):
        keep(tmp_path / "histories", trial, "zx200:swing", told("cancel", Hit(HIT, (), {}, HIT)))
    lines = (tmp_path / "histories" / "zx200.jsonl").read_text(encoding="utf-8").splitlines()
    assert len(lines) == 2 and json.loads(lines[0])["relay"] == "zx200:swing"
    read = [Happening(**one) for one in json.loads(lines[1])["happened"]]
    assert read == told("cancel", Hit(HIT, (), {}, HIT))
