"""Reasons: declared once, carried as a line, shown in two languages."""

import json
from dataclasses import FrozenInstanceError

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tms_reason import texts, wire
from tms_reason.errors import TmsError
from tms_reason.quantities import Seconds
from tms_reason.reason import REGISTRY, Foreign, Reason, Several, Unknown
from tms_reason.remedies import REARM


class ShownLatched(Reason, text="{machine} is latched: {cause}", action=REARM):
    machine: str
    cause: Reason


class ShownSilent(Reason, text="{what} {age} old", details="of {topic}"):
    what: str
    age: Seconds
    topic: str


class ShownMissing(Reason, text="missing: {names}"):
    names: tuple[str, ...]


SILENT = ShownSilent("joint states", 1.25, "/zx200/joint_states")
LATCHED = ShownLatched("zx200", SILENT)


def test_a_reason_has_a_code_a_text_and_something_to_do() -> None:
    assert LATCHED.code == "SHOWN_LATCHED"
    assert texts.text(LATCHED, "en") == "zx200 is latched: joint states 1.2 s old"
    assert texts.advice(LATCHED, "en") == "Look at the machine, then re-arm it: `tms rearm zx200`"
    assert texts.details(LATCHED, "en") == "of /zx200/joint_states"
    assert str(TmsError(LATCHED)) == texts.sentence(LATCHED, "en")


@pytest.mark.parametrize("reason", [LATCHED, SILENT, ShownMissing(("a", "b c")), Several((SILENT, Foreign("x = 1")))])
def test_it_survives_the_way(reason: Reason) -> None:
    assert wire.of(wire.to_line(reason)) == reason
    assert wire.of_data(json.loads(json.dumps(wire.to_data(reason)))) == reason
    assert "\n" not in wire.to_line(reason)


@given(st.text(min_size=1))
def test_any_text_of_another_system_is_a_foreign_reason(words: str) -> None:
    found = wire.known(words)
    assert isinstance(found, (Foreign, Unknown)) or found.code in REGISTRY
    assert wire.of(wire.to_line(Foreign(words))) == Foreign(words)


@pytest.mark.parametrize(
    "line",
    [
        "NEVER_DECLARED a=1",
        'SHOWN_SILENT what="x"',
        'SHOWN_SILENT what=1 age=1.0 topic=""',
        'SHOWN_LATCHED machine="zx200" cause={"code": 1}',
        'SHOWN_LATCHED machine="zx200" cause="none"',
    ],
)
def test_a_code_or_an_argument_of_another_release_is_shown_as_it_is(line: str) -> None:
    found = wire.known(line)
    assert isinstance(found, Unknown) and texts.text(found, "en") == line.split()[0]


def test_no_line_is_no_reason() -> None:
    assert wire.of("") is None and wire.to_line(None) == ""


def test_reasons_inside_each_other_without_end_are_refused() -> None:
    data: dict[str, object] = wire.to_data(SILENT)
    for _ in range(20):
        data = {"code": "SHOWN_LATCHED", "args": {"machine": "m", "cause": data}}
    line = f'SHOWN_LATCHED machine="m" cause={json.dumps(data)}'
    assert isinstance(wire.known(line), Reason)
    assert isinstance(wire.known("SHOWN_LATCHED machine=" + "[" * 100_000), Foreign)


def test_it_is_equal_by_kind_and_arguments_and_frozen() -> None:
    twin = ShownSilent(what="joint states", topic="/zx200/joint_states", age=1.25)
    assert twin == SILENT and hash(twin) == hash(SILENT)
    assert twin != ShownSilent("joint states", 1.5, "/zx200/joint_states") and Foreign("a") != Several(())
    with pytest.raises(FrozenInstanceError):
        twin.what = "odom"  # type: ignore[misc]


@pytest.mark.parametrize(
    ("values", "named"), [((), {}), (("a",), {}), (("a", 1.0, "/x", 2), {}), (("a", 1.0), {"what": "b"}),
                          (("a", 1.0), {"topic": "/x", "other": 1})]
)  # fmt: skip
def test_it_takes_exactly_its_arguments(values: tuple[object, ...], named: dict[str, object]) -> None:
    with pytest.raises(TypeError, match="ShownSilent takes what, age, topic"):
        ShownSilent(*values, **named)  # type: ignore[arg-type]


def test_a_code_is_declared_once() -> None:
    with pytest.raises(TypeError, match="both declare the reason FOREIGN"):

        class Another(Reason, text="{words}", code="FOREIGN"):
            words: str
