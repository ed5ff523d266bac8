"""Clouds of a scanner become heights for tms:ground; others are refused with their reason."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import structlog
from builtin_interfaces.msg import Time
from tms_msg_ground.msg import HeightPatch

from tms_config.site_file import Scanner
from tms_machine.sensing import TerrainInput
from tms_reason.wire import of
from tms_sim.scanners import cloud, scanned
from tms_soil.patches import heights
from tms_soil.surface import Heights
from tms_sp import terrain
from tms_sp.reasons import CloudFrame, CloudNotPoints, MeasuredEarlier, StampInFuture
from tms_sp.terrain import TerrainSensing

NOW = 1000.0


class World:
    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(terrain, "unix_time", lambda: NOW)
        self.told: list[HeightPatch] = []
        ros = SimpleNamespace(
            publisher=lambda *_, **__: SimpleNamespace(publish=self.told.append), subscribe=lambda *_, **__: None
        )
        app: Any = SimpleNamespace(ros=ros, log=structlog.stdlib.get_logger("test"))
        self.input = TerrainSensing(app, "mast", TerrainInput(topic="/mast/points", hz=1.0), 0.5)

    def send(self, stamp: float = NOW, frame: str = "map", **wrong: Any) -> Any:
        message = cloud(scanned(hilly(), (0.0, 0.0), Scanner(height=6.0, range=8.0), np.random.default_rng(1)))
        message.header.frame_id, message.header.stamp = frame, Time(sec=int(stamp), nanosec=int(stamp % 1 * 1e9))
        for name, value in wrong.items():
            setattr(message, name, value)
        self.input.receive(message)
        return of(self.input.state().last_refusal)


def hilly() -> Heights:
    found = Heights(-10.0, -10.0, 0.1, np.zeros((200, 200)))
    x, y = found.centres
    found.z[:] = 0.1 * x + 0.2 * np.sin(y)
    return found


def test_a_scan_becomes_the_ground_that_was_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    world = World(monkeypatch)
    assert world.send() is None
    (message,) = world.told
    found, true = heights(message), hilly()
    assert message.header.stamp.sec == NOW and found.cell == 0.1
    known = np.isfinite(found.z)
    off = found.z[known] - true.at(*(one[known] for one in found.centres))
    assert known.mean() > 0.5 and abs(off.mean()) < 1e-3 and off.std() == pytest.approx(0.01, rel=0.1)
    state = world.input.state()
    assert (state.accepted, state.refused, state.state) == (1, 0, "alive")


@pytest.mark.parametrize(("wrong", "reason"), [
    ({"frame": "zx200/base_link"}, CloudFrame), ({"stamp": NOW + 2.0}, StampInFuture), ({"fields": []}, CloudNotPoints),
    ({"row_step": 7}, CloudNotPoints), ({"data": []}, CloudNotPoints),
])  # fmt: skip
def test_what_is_no_cloud_of_now_is_refused(
    monkeypatch: pytest.MonkeyPatch, wrong: dict[str, Any], reason: type
) -> None:
    world = World(monkeypatch)
    assert isinstance(world.send(**wrong), reason)
    assert not world.told and world.input.state().refused == 1


def test_a_clock_that_goes_back_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    world = World(monkeypatch)
    world.send(NOW - 1.0)
    assert isinstance(world.send(NOW - 5.0), MeasuredEarlier) and len(world.told) == 1
    world.send(NOW)
    assert len(world.told) == 2
