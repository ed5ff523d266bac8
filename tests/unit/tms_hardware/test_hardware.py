"""What the hardware of a machine forbids, and what follows when it tells nothing."""

import math
from pathlib import Path

import pytest

from tms_config.config import load_site
from tms_hardware.hardware import Condition, Hardware
from tms_hardware.reasons import (
    CounterFrozen,
    EmergencyStopPressed,
    EngineOff,
    LeverLocked,
    SignalSilent,
    SignalUnheard,
    SignalUnreadable,
    SwitchedToManual,
)
from tms_hardware.settings import HardwareSettings, Signal, Value, hardware_of
from tms_reason.errors import ConfigError
from tms_reason.reason import Reason

ALL = HardwareSettings.model_validate(
    {
        "emergency_stop": {"topic": "relay"},
        "lock_lever": {"topic": "lever"},
        "manual": {"topic": "setting", "type": "std_msgs/msg/UInt8", "when": 0},
        "engine": {"topic": "rpm", "type": "std_msgs/msg/UInt16", "above": 500},
        "alive": {"topic": "alive"},
    }
)
FINE: dict[str, Value] = {"emergency_stop": False, "lock_lever": False, "manual": 1, "engine": 900, "alive": 7}
SAID = {"emergency_stop": "no", "lock_lever": "no", "manual": "no", "engine": "yes", "alive": "yes"}


def told(**other: Value) -> Hardware:
    made = Hardware("zx200", ALL, 0.0)
    for name, value in {**FINE, **other}.items():
        made.heard(name, 0.0, value)
    return made


def test_a_machine_that_may_move() -> None:
    made = told()
    assert made.look(0.9) == Condition() and made.state(0.9) == SAID


@pytest.mark.parametrize(
    ("source", "value", "condition"),
    [
        ("emergency_stop", True, Condition(stop=EmergencyStopPressed("zx200"))),
        ("lock_lever", True, Condition(hold=LeverLocked("zx200"))),
        ("manual", 0, Condition(hold=SwitchedToManual("zx200"))),
        ("engine", 500, Condition(hold=EngineOff("zx200"))),
    ],
)
def test_what_forbids_motion(source: str, value: Value, condition: Condition) -> None:
    made = told(**{source: value})
    assert made.look(0.5) == condition and condition.wrong is not None
    made.heard(source, 0.6, FINE[source])
    assert made.look(0.6) == Condition()


def test_a_site_may_latch_for_what_holds() -> None:
    settings = HardwareSettings.model_validate({"lock_lever": {"topic": "lever", "then": "latch"}})
    made = Hardware("zx200", settings, 0.0)
    made.heard("lock_lever", 0.0, True)
    assert made.look(0.0) == Condition(stop=LeverLocked("zx200"))


@pytest.mark.parametrize("source", ["emergency_stop", "lock_lever", "manual", "engine"])
def test_a_source_that_falls_silent_is_a_loss(source: str) -> None:
    made = told()
    for name in set(FINE) - {source}:
        made.heard(name, 1.4, 8 if name == "alive" else FINE[name])
    assert made.look(1.5) == Condition(lost=SignalSilent("zx200", source, 1.5))
    assert made.state(1.5) == {**SAID, source: "unknown"}


def test_a_pressed_stop_that_falls_silent_is_no_released_one() -> None:
    assert told(emergency_stop=True).look(1.5).wrong is not None


def test_a_counter_that_stands_still_is_a_loss_though_it_is_told() -> None:
    made = told()
    for at in (0.4, 0.8, 1.2):
        for name, value in FINE.items():
            made.heard(name, at, value)
    assert made.look(1.2) == Condition(lost=CounterFrozen("zx200", 1.2))
    assert made.state(1.2) == {**SAID, "alive": "no"}
    made.heard("alive", 1.3, 0)  # it began anew
    assert made.look(1.3) == Condition()


def test_what_was_never_told_is_not_known() -> None:
    made = Hardware("zx200", ALL, 0.0)
    assert made.look(0.1) == Condition(lost=SignalUnheard("zx200", "emergency_stop"))
    assert set(made.state(0.1).values()) == {"unknown", "no"}


@pytest.mark.parametrize("value", [math.nan, [1], None])
def test_what_cannot_be_read_is_a_loss(value: object) -> None:
    made = told()
    made.heard("engine", 0.1, value)
    assert made.look(0.1) == Condition(lost=SignalUnreadable("zx200", "engine"))


@pytest.mark.parametrize("signal", [{}, {"when": False}, {"when": 2}, {"when": "on"}, {"above": 500.0}])
def test_a_stand_in_can_say_yes_and_no(signal: dict[str, Value]) -> None:
    one = Signal.model_validate({"topic": "lever", **signal})
    assert one.says_yes(one.value(True)) and not one.says_yes(one.value(False))


def test_a_mistake_in_the_site_file_is_named(tmp_path: Path) -> None:
    file = tmp_path / "site.yaml"
    site = "{name: test, domain: 1, services: {}, machines: {zx200: {model: zx200, hardware: {lever: {topic: a}}}}}"
    file.write_text(site)
    with pytest.raises(ConfigError) as error:
        hardware_of(load_site(str(file)), "zx200")
    found: Reason = error.value.reason
    assert "machines.zx200.hardware.lever" in str(found)
