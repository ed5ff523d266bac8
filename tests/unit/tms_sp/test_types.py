"""Declared inputs against the real message types: what is refused before anything starts, and what is heard."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from geometry_msgs.msg import PoseStamped
from std_msgs.msg import UInt64, UInt64MultiArray

from tms_config.config import CONFIGS, load_site
from tms_machine.sensing import Input, load_sensing
from tms_reason.errors import ConfigError
from tms_sp.inputs import SensingInput
from tms_sp.node import _input
from tms_sp.reasons import ValueTooLarge, WrongKindOf

POSE = "geometry_msgs/msg/PoseStamped"
HERE = {"topic": "/t", "model": "zx200", "record": "seen"}
SITES = [CONFIGS / "site.yaml", *sorted((CONFIGS / "sites").glob("*.yaml"))]


def made(name: str, given: Input, site: Any = None) -> SensingInput:
    app: Any = SimpleNamespace(site=site or load_site(str(SITES[0])))
    sender: Any = SimpleNamespace(put=lambda update: True)
    return _input(app, name, given, 0.5, sender)


@pytest.mark.parametrize("fields", [{"p": "pose.position"}, {}])
def test_an_input_that_takes_a_message_whole_is_refused_at_the_start(fields: dict[str, str]) -> None:
    with pytest.raises(ConfigError, match=r"inputs\.pose: pose(\.position)? is a geometry_msgs/P") as reported:
        made("pose", Input.model_validate({**HERE, "type": POSE, "fields": fields}))
    assert reported.value.reason.find(WrongKindOf)


def test_numbers_inside_it_are_heard() -> None:
    one = made("pose", Input.model_validate({**HERE, "type": POSE, "fields": {"x": "pose.position.x"}}))
    one.receive(PoseStamped())
    assert one.accepted == 1


@pytest.mark.parametrize(("kind", "value"), [(UInt64, 2**63), (UInt64MultiArray, [1, 2**64 - 1])])
def test_a_number_that_no_record_can_hold_is_refused_and_the_next_one_heard(kind: Any, value: Any) -> None:
    given = {**HERE, "type": f"std_msgs/msg/{kind.__name__}", "fields": {"n": "data"}}
    one = made("big", Input.model_validate(given))
    one.receive(kind(data=value))
    assert one.refused == 1 and isinstance(one.last_refusal, ValueTooLarge)
    one.receive(kind(data=[1] if isinstance(value, list) else 1))
    assert one.accepted == 1


@pytest.mark.parametrize("path", SITES, ids=lambda path: path.stem)
def test_every_declared_input_can_be_heard(path: Path) -> None:
    site = load_site(str(path))
    for name, given in load_sensing(site).inputs.items():
        made(name, given, site)
