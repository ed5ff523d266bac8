"""Where the console shows machines: as their pose topics tell, or /tf."""

from types import SimpleNamespace
from typing import Any

import pytest
from geometry_msgs.msg import PoseStamped, TransformStamped
from tf2_msgs.msg import TFMessage

from tms_config.clock import monotonic
from tms_config.models import Border, Source
from tms_config.site_file import Console
from tms_ros.topics import Arrival
from tms_ur.models import Place
from tms_ur.site_client import SiteClient

SOURCE = Source(period=0.06, stamps="since_start", frozen_after=5.0, origin="a test")
BORDERS = {"digger": Border(pose="base_link/pose", sources={"pose": SOURCE}), "dump": Border(base_frame="dump/base")}
AGE = 3.0  # s


def posed(x: float) -> PoseStamped:
    message = PoseStamped()
    message.header.frame_id, message.pose.position.x, message.pose.orientation.w = "world", x, 1.0
    return message


def framed(x: float) -> TFMessage:
    one = TransformStamped(child_frame_id="dump/base")
    one.header.frame_id, one.transform.translation.x, one.transform.rotation.w = "map", x, 1.0
    return TFMessage(transforms=[one])


def test_places_of_machines_and_their_ages(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tms_ur.site_client.table", lambda _: [])
    ros: Any = SimpleNamespace(
        peer=lambda *_: None, subscribe=lambda *_, **__: None, prepare=lambda *_: None,
        sample_arrivals=lambda _, topic: lambda: [Arrival(posed(1.234), monotonic() - AGE, 1)],
        sample=lambda kind, *_: lambda: [framed(5.0)] if kind is TFMessage else [],
        poll_in_thread=lambda _, step, __: step(),
    )  # fmt: skip
    machines = {name: SimpleNamespace(hardware={}) for name in BORDERS}
    file = SimpleNamespace(machines=machines, ground=None, console=Console())
    site: Any = SimpleNamespace(file=file, border=BORDERS.__getitem__, area_files=[])
    shown = {machine.name: machine for machine in SiteClient(ros, site).board.snapshot().machines}
    assert {name: one.place for name, one in shown.items()} == {
        "digger": Place(x=1.23, y=0.0, yaw=0.0), "dump": Place(x=5.0, y=0.0, yaw=0.0),
    }  # fmt: skip
    ages = {name: one.place_age for name, one in shown.items()}
    assert ages["digger"] is not None and ages["digger"] >= AGE and ages["dump"] is not None
