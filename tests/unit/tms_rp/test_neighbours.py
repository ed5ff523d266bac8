"""Where other machines stand, and what the collision check makes of it."""

from types import SimpleNamespace
from typing import Any

import pytest
import structlog
from geometry_msgs.msg import TransformStamped
from tf2_msgs.msg import TFMessage

from tms_rp.neighbours import Neighbours
from tms_rp.reasons import PartOf

BASES = {"zx200": "base_link", "ic120": "ic120_tf/base_link"}


def at(child: str, x: float, parent: str = "map") -> TransformStamped:
    one = TransformStamped(child_frame_id=child)
    one.header.frame_id = parent
    one.transform.translation.x, one.transform.rotation.w = x, 1.0
    return one


def neighbours(*reported: TransformStamped) -> Neighbours:
    """Those of zx200, who have heard `told` twice."""
    site: Any = SimpleNamespace(
        border=lambda name: SimpleNamespace(base_frame=BASES[name]),
        file=SimpleNamespace(machines=BASES),
        model_of=lambda _: SimpleNamespace(footprint={"body": object()}),
    )
    ros = SimpleNamespace(
        sample=lambda *_: lambda: [TFMessage(transforms=list(reported))],
        poll_in_thread=lambda *_: None,
        subscribe=lambda *_, **__: None,
    )
    made = Neighbours(SimpleNamespace(site=site, machine="zx200", log=structlog.stdlib.get_logger("test"), ros=ros))  # type: ignore[arg-type]
    made._take_frames()
    made._take_frames()
    return made


def test_the_other_is_seen_from_here_also_through_odom() -> None:
    (obstacle,) = neighbours(
        at("odom", 2.0), at("base_link", 1.0, "odom"), at("ic120_tf/base_link", 10.0), at("other", 4.0)
    ).obstacles()
    assert obstacle.name == PartOf("body", "ic120")
    assert obstacle.place[0, 3] == pytest.approx(7.0)


def test_a_place_that_is_not_a_number_leaves_the_machine_where_it_was() -> None:
    bad = [at("ic120_tf/base_link", value) for value in (float("nan"), float("inf"))]
    (obstacle,) = neighbours(at("base_link", 0.0), at("ic120_tf/base_link", 7.0), *bad).obstacles()
    assert obstacle.place[0, 3] == 7.0


def test_who_does_not_know_its_own_place_says_so(caplog: pytest.LogCaptureFixture) -> None:
    assert neighbours(at("ic120_tf/base_link", 7.0)).obstacles() == []
    assert "event=place_unknown target=zx200" in caplog.text
