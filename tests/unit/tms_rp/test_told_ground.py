"""The planner asks for the ground where its machine stands, and keeps what it was told."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import structlog
from tms_msg_ground.srv import GetHeights

from tms_config.config import load_site
from tms_machine.frames import FramePose
from tms_reason.errors import RosError
from tms_ros.reasons import NoAnswer
from tms_rp import told_ground
from tms_rp.told_ground import ToldGround
from tms_soil import patches
from tms_soil.surface import Heights

SITE = "name: t\ndomain: 43\nservices: {db: {}}\nmachines: {zx200: {model: zx200}}\n"


class World:
    def __init__(self, folder: Path, monkeypatch: pytest.MonkeyPatch, more: str = "ground: {area: [0, 0, 9, 9]}\n"):
        (folder / "site.yaml").write_text(SITE + more)
        self.there, self.silent, self.place = True, False, FramePose(3.0, 4.0, 0.5, 0.0)
        self.asked: list[GetHeights.Request] = []
        self.z = 1.0
        places = SimpleNamespace(place=lambda _: self.place, take=lambda: None)
        monkeypatch.setattr(told_ground, "Places", lambda *_: places)
        ros = SimpleNamespace(
            prepare=lambda *_: None, poll_in_thread=lambda *_: None, has_service=lambda *_: self.there, call=self.call
        )
        app: Any = SimpleNamespace(
            site=load_site(str(folder / "site.yaml")), machine="zx200", ros=ros, log=structlog.stdlib.get_logger("test")
        )
        self.ground = ToldGround(app)

    def call(self, kind: Any, name: str, request: GetHeights.Request, _: float) -> GetHeights.Response:
        if self.silent:
            raise RosError(NoAnswer("tms:ground", name, 0.8))
        self.asked.append(request)
        heap = Heights(-17.0, -16.0, 0.2, np.full((200, 200), self.z))
        heap.z[120:, :] += 1.0  # from y = 8 on
        return GetHeights.Response(ground=patches.patch(heap))

    def tops(self) -> tuple[float, float]:
        """Of the lowest and of the highest part."""
        found = self.ground.around()
        assert found is not None
        tops = [round(float(one.place[2, 3]), 6) for one in found.whole]
        return min(tops), max(tops)


def test_the_ground_around_the_machine_now(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    world = World(tmp_path, monkeypatch)
    assert world.tops() == (0.0, 1.0), "from the height of its tracks"
    (request,) = world.asked
    assert (request.x0 + request.x1, request.y0 + request.y1) == (6.0, 8.0)
    world.z = -5.0
    assert world.tops() == (0.0, 1.0) and len(world.asked) == 2


@pytest.mark.parametrize("silent", [True, False])
def test_what_was_told_last_stays(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, silent: bool) -> None:
    world = World(tmp_path, monkeypatch)
    world.there, world.silent = silent, silent
    assert world.ground.around() is None, "nobody has told anything yet"
    world.there, world.silent = True, False
    world.tops()
    world.there, world.silent = silent, silent
    assert world.tops() == (0.0, 1.0) and len(world.asked) == 1


def test_a_site_without_a_ground_and_a_machine_without_a_place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert World(tmp_path, monkeypatch, "").ground.around() is None
    world = World(tmp_path, monkeypatch)
    world.place = None  # type: ignore[assignment]
    assert world.ground.around() is None and not world.asked
