"""Where the console shows machines: as their pose topics tell, or /tf."""

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest
from geometry_msgs.msg import PoseStamped, TransformStamped
from tf2_msgs.msg import TFMessage
from tms_msg_sp.msg import InputState, InputStates

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


def client(monkeypatch: pytest.MonkeyPatch) -> tuple[SiteClient, dict[str, Callable[[Any], None]]]:
    """The client of a site with two machines, and what it does with messages, by topic."""
    heard: dict[str, Callable[[Any], None]] = {}
    monkeypatch.setattr("tms_ur.site_client.table", lambda _: [])
    ros: Any = SimpleNamespace(
        peer=lambda *_: None, subscribe=lambda _, topic, hear, **__: heard.update({topic: hear}),
        prepare=lambda *_: None,
        sample_arrivals=lambda _, topic: lambda: [Arrival(posed(1.234), monotonic() - AGE, 1)],
        sample=lambda kind, *_: lambda: [framed(5.0)] if kind is TFMessage else [],
        poll_in_thread=lambda _, step, __: step(),
    )  # fmt: skip
    machines = {name: SimpleNamespace(hardware={}) for name in BORDERS}
    file = SimpleNamespace(machines=machines, ground=None, console=Console(), pcs={})
    site: Any = SimpleNamespace(file=file, border=BORDERS.__getitem__, area_files=[])
    return SiteClient(ros, site), heard


def test_places_of_machines_and_their_ages(monkeypatch: pytest.MonkeyPatch) -> None:
    made, _ = client(monkeypatch)
    shown = {machine.name: machine for machine in made.board.snapshot().machines}
    assert {name: one.place for name, one in shown.items()} == {
        "digger": Place(x=1.23, y=0.0, yaw=0.0), "dump": Place(x=5.0, y=0.0, yaw=0.0),
    }  # fmt: skip
    ages = {name: one.place_age for name, one in shown.items()}
    assert ages["digger"] is not None and ages["digger"] >= AGE and ages["dump"] is not None


def test_sensing_inputs_reach_the_page_and_the_alarms(monkeypatch: pytest.MonkeyPatch) -> None:
    made, heard = client(monkeypatch)
    alarms: dict[str, str] = {}
    monkeypatch.setattr(made.board, "put_inputs", alarms.update)
    heard["/tms/sp/inputs"](InputStates(inputs=[InputState(name="pile", state="silent")]))
    assert alarms == {"pile": "silent"}
    assert [(one.name, one.state) for one in made.sensing().inputs] == [("pile", "silent")]
