"""What somebody has measured goes into the ground where nothing newer is known."""

import threading
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import structlog
from tms_msg_ground.msg import HeightPatch

from earth_rig import dig_poses, model_of, moved, reports, soils
from tms_ground import seen, watching
from tms_ground.reasons import SeenFromFuture, SeenNotHeights
from tms_ground.seen import NOISE, Seen
from tms_ground.settings import Ground
from tms_ground.watching import GroundWatch
from tms_machine.frames import FramePose
from tms_machine.stamps import time
from tms_soil import patches
from tms_soil.surface import Heights

NOW = 5000.0


class World:
    def __init__(self, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        self.now = NOW
        for module in (seen, watching):
            monkeypatch.setattr(module, "unix_time", lambda: self.now)
        ground, models = Ground(area=(-10.0, -10.0, 10.0, 10.0)), {"zx200": model_of("zx200")}
        self.watch = GroundWatch(ground, {"earth": soils()[0]}, models, folder / "ground.npz")
        app: Any = SimpleNamespace(
            ros=SimpleNamespace(subscribe=lambda *_, **__: None), log=structlog.stdlib.get_logger("test")
        )
        self.seen = Seen(app, self.watch, threading.Lock())

    def send(self, z: float, stamp: float) -> None:
        message = patches.patch(Heights(-10.0, -10.0, 0.1, np.full((200, 200), z)))
        message.header.stamp = time(stamp)
        self.seen.receive(message)

    @property
    def z(self) -> np.ndarray:
        return self.watch.earth.grid.heights((-10.0, -10.0, 10.0, 10.0), side=1).z


def test_newer_measurements_win_and_older_ones_do_not(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    world = World(tmp_path, monkeypatch)
    world.send(0.3, NOW - 10.0)
    assert world.z == pytest.approx(0.3, abs=1e-6) and world.watch.mass_error == pytest.approx(0.0, abs=1e-3)
    for report in reports(moved(dig_poses(), rate=25.0)):
        world.watch.take("zx200", report.time, report.angles, FramePose(0.0, 0.0, 0.0, 0.0))
    dug = world.z < 0.1
    world.send(0.3, NOW - 5.0)
    assert dug.any() and (world.z[dug] < 0.1).all(), "it was scanned before it was dug"
    world.now += 5.0
    ages = world.watch.ages(world.watch.earth.grid.heights((-10.0, -10.0, 10.0, 10.0), side=1))
    assert ages[dug] == pytest.approx(5.0) and ages[0, 0] == pytest.approx(10.0)
    world.send(0.3, NOW + 4.0)
    assert (np.abs(world.z - 0.3) <= NOISE + 1e-6).all()


def test_noise_moves_no_soil(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    world = World(tmp_path, monkeypatch)
    for k in range(5):
        world.send(0.8 * NOISE * (-1) ** k, NOW - 10.0 + k)
    assert not world.z.any()


def test_the_future_and_what_is_no_ground_are_refused_and_told_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    world = World(tmp_path, monkeypatch)
    with structlog.testing.capture_logs() as logs:
        world.send(9.0, NOW + 60.0)
        world.send(9.0, NOW + 61.0)
        world.seen.receive(HeightPatch(rows=3, columns=2, cell=0.1))
    assert [type(one["reason"]) for one in logs] == [SeenFromFuture, SeenNotHeights] and not world.z.any()
