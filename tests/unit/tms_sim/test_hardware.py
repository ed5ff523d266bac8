"""The hardware of a stand-in tells what it should, so that a gateway lets the machine move, and its faults."""

from types import SimpleNamespace
from typing import Any

import pytest

from tms_config.site_file import Fault
from tms_hardware.hardware import Condition, Hardware
from tms_hardware.settings import hardware_of
from tms_sim.hardware import HardwareStandIn

GIVEN = {
    "emergency_stop": {"topic": "relay", "when": False},
    "lock_lever": {"topic": "lever"},
    "manual": {"topic": "setting", "type": "std_msgs/msg/UInt8", "when": 0},
    "engine": {"topic": "rpm", "type": "std_msgs/msg/UInt16", "above": 500},
    "alive": {"topic": "alive", "type": "std_msgs/msg/Header", "field": "stamp.sec"},
}


def condition(fault: Fault) -> tuple[Condition, dict[str, str]]:
    """What follows from what it tells for 2 s."""
    topics: dict[str, list[Any]] = {}
    machine = SimpleNamespace(hardware=GIVEN)
    site: Any = SimpleNamespace(file=SimpleNamespace(machines={"zx200": machine}))

    def publisher(_type: Any, topic: str) -> Any:
        return SimpleNamespace(publish=topics.setdefault(topic, []).append)

    app: Any = SimpleNamespace(site=site, ros=SimpleNamespace(publisher=publisher))
    stand_in, settings = HardwareStandIn(app, "zx200"), hardware_of(site, "zx200")
    hardware = Hardware("zx200", settings, 0.0)
    for beat in range(20):
        stand_in.tell(fault)
        for name, source in settings.sources.items():
            for message in topics[f"/zx200/{source.topic}"]:
                hardware.heard(name, beat / 10, message.stamp.sec if name == "alive" else message.data)
            topics[f"/zx200/{source.topic}"].clear()
    return hardware.look(2.0), dict(hardware.state(2.0))


def test_without_a_fault_it_may_move() -> None:
    found, state = condition(Fault())
    assert found == Condition()
    assert state == {"emergency_stop": "no", "lock_lever": "no", "manual": "no", "engine": "yes", "alive": "yes"}


@pytest.mark.parametrize("source", GIVEN)
def test_each_fault_forbids_motion(source: str) -> None:
    told, _ = condition(Fault(hardware=(source,)))
    mute, _ = condition(Fault(hardware_mute=(source,)))
    assert told.wrong is not None and mute.lost is not None
    assert told != mute or source == "alive"
