"""Grounds between tms:ground and the database: what is newer wins, ours are stored."""

import threading
from datetime import datetime, timedelta, timezone
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import structlog
from tms_msg_ground.srv import ReadSnapshot, TakeSnapshot, WriteSnapshot

from earth_rig import dig_poses, model_of, moved, reports, soils
from tms_ground import snapshots, watching
from tms_ground.reasons import GroundFromFuture
from tms_ground.settings import Ground
from tms_ground.snapshots import EACH_HOUR, END_OF_DAY, PERIOD, READ, SERVICE, WRITE, Snapshots
from tms_ground.watching import GroundWatch
from tms_machine.frames import FramePose
from tms_reason.errors import RosError
from tms_ros.reasons import NoAnswer
from tms_soil import patches
from tms_soil.surface import Heights

AREA = (-10.0, -10.0, 10.0, 10.0)
NOON = datetime(2026, 11, 26, 12, tzinfo=timezone.utc)


class Site:
    """tms:ground and a database; `now` is the time of both."""

    def __init__(self, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        self.now, self.there, self.refusal = NOON, True, ""
        self.stored: list[tuple[datetime, Heights, str]] = []
        self.folder, self.services = folder, dict[str, Any]()
        self.steps: dict[float, Any] = {}
        monkeypatch.setattr(snapshots, "utc_now", lambda: self.now)
        monkeypatch.setattr(watching, "utc_now", lambda: self.now)
        monkeypatch.setattr(watching, "unix_time", lambda: self.now.timestamp())
        self.app: Any = SimpleNamespace(
            log=structlog.stdlib.get_logger("test"),
            ros=SimpleNamespace(
                prepare=lambda *_: None, has_service=lambda *_: self.there, call=self.call,
                offer_slow=lambda _, name, handler: self.services.update({name: handler}),
                poll_in_thread=lambda period, step, _: self.steps.update({period: step}),
            ),
        )  # fmt: skip
        self.start()

    def start(self) -> None:
        ground = Ground.model_validate({"area": AREA})
        self.watch = GroundWatch(
            ground, {"earth": soils()[0]}, {"zx200": model_of("zx200")}, self.folder / "ground.npz"
        )
        if self.watch.file.exists():
            assert self.watch.load()
        Snapshots(self.app, self.watch, threading.Lock())

    def restart(self) -> None:
        if (content := self.watch.content()) is not None:
            self.watch.file.write_bytes(content.ground)
        self.start()

    def call(self, kind: Any, name: str, request: Any, _: float) -> Any:
        if not self.there:
            raise RosError(NoAnswer("tms:db", name, 60.0))
        if self.refusal:
            return kind.Response(error_code="STORE_DOWN", error_msg="")
        if name == WRITE:
            self.store(patches.heights(request.ground), request.source)
            return WriteSnapshot.Response(taken_at=self.now.isoformat())
        assert name == READ
        found = [one for one in self.stored if not request.after or one[0] > datetime.fromisoformat(request.after)]
        if not found:
            return ReadSnapshot.Response(error_code="" if request.after else "GROUND_NOT_THERE")
        time, ground, source = found[0 if request.snapshot == "first" else -1]
        return ReadSnapshot.Response(ground=patches.patch(ground), taken_at=time.isoformat(), source=source)

    def store(self, ground: Heights, source: str = "survey.laz") -> None:
        self.stored.append((self.now, ground, source))

    def look(self, minutes: float = 1.0) -> None:
        self.steps[PERIOD]()
        self.now += timedelta(minutes=minutes)

    def dig(self) -> None:
        for report in reports(moved(dig_poses(), rate=25.0)):
            self.watch.take("zx200", report.time, report.angles, FramePose(0.0, 0.0, 0.0, 0.0))
        self.now += timedelta(minutes=1)

    @property
    def z(self) -> np.ndarray:
        return self.watch.earth.grid.heights(AREA).z


@pytest.fixture
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Site:
    return Site(tmp_path, monkeypatch)


def level(z: float) -> Heights:
    return Heights(-10.0, -10.0, 0.2, np.full((100, 100), z))


def test_it_begins_with_the_newest_ground_once_the_database_is_there(site: Site) -> None:
    site.store(level(1.0))
    site.now += timedelta(minutes=1)
    site.store(level(2.0))
    site.there = False
    site.look()
    assert (site.z == 0.0).all()
    site.there = True
    site.look()
    assert site.z == pytest.approx(2.0) and site.watch.mass_error == pytest.approx(0.0, abs=1e-3)


def test_what_machines_have_changed_since_stays(site: Site) -> None:
    site.store(level(0.2))
    site.now += timedelta(minutes=1)
    site.dig()
    dug = site.z < -0.1
    assert dug.any()
    site.look()
    assert (site.z[dug] < 0.0).all(), "dug after the survey"
    assert site.z[0, 0] == pytest.approx(0.2)
    site.store(level(0.3))
    site.look()
    assert site.z == pytest.approx(0.3), "surveyed after the dig"


@pytest.mark.parametrize("old_file", [False, True])
def test_a_kept_ground_goes_on(site: Site, old_file: bool) -> None:
    site.store(level(0.0))
    site.look()
    site.dig()
    before = site.z
    site.restart()
    if old_file:  # of a release that knew no evidence
        with np.load(site.watch.file) as kept:
            parts = {name: kept[name] for name in kept.files if name not in (watching.TIMES, watching.NEWEST)}
        np.savez(site.watch.file, **parts)
        site.start()
    site.look()
    assert np.array_equal(site.z, before)
    site.store(level(0.4))
    site.look()
    assert site.z == pytest.approx(0.4)


def test_the_day_is_closed_with_a_snapshot_of_what_machines_did(site: Site) -> None:
    site.look(minutes=24 * 60)
    site.look()
    assert not site.stored, "nothing has changed"
    site.dig()
    site.there = False
    site.look(minutes=24 * 60)
    site.look()
    site.there = True
    for _ in range(3):
        site.look()
    ((_, ground, source),) = site.stored
    assert source == END_OF_DAY and np.allclose(ground.z, site.z, atol=1e-6)


def test_each_hour_it_is_stored_if_machines_have_changed_it(site: Site) -> None:
    site.look()
    site.dig()
    site.look(minutes=59)
    assert not site.stored
    for _ in range(2):
        site.look(minutes=1)
    assert [source for _, _, source in site.stored] == [EACH_HOUR]
    site.look(minutes=60)
    assert len(site.stored) == 1, "nothing has changed"


def test_ours_does_not_blur_the_ground(site: Site) -> None:
    site.dig()
    fine = site.watch.earth.grid.heights(side=1).z
    found = site.services[SERVICE](TakeSnapshot.Request(source="me"), TakeSnapshot.Response())
    assert (found.taken_at, found.error_code) == (site.now.isoformat(), "")
    assert site.stored[0][2] == "me"
    for _ in range(2):
        site.look()
    site.restart()
    site.look()
    assert np.array_equal(site.watch.earth.grid.heights(side=1).z, fine, equal_nan=True)


def test_one_that_came_between_is_not_missed(site: Site) -> None:
    site.store(level(0.0))
    site.look()
    site.store(level(0.5))
    site.now += timedelta(minutes=1)
    site.services[SERVICE](TakeSnapshot.Request(), TakeSnapshot.Response())
    site.look()
    assert site.z == pytest.approx(0.5)


def test_a_ground_from_the_future_is_refused_and_told_once(site: Site) -> None:
    site.now += timedelta(days=1)
    site.store(level(5.0))
    site.now -= timedelta(days=1)
    with structlog.testing.capture_logs() as logs:
        site.look()
        site.look()
    (line,) = logs
    assert isinstance(line["reason"], GroundFromFuture) and (site.z == 0.0).all()
    site.now += timedelta(days=1)
    site.look()
    assert site.z == pytest.approx(5.0)


def test_a_database_that_refuses_is_told(site: Site) -> None:
    site.dig()
    site.refusal = "down"
    found = site.services[SERVICE](TakeSnapshot.Request(), TakeSnapshot.Response())
    assert found.error_code == "STORE_DOWN"
    with structlog.testing.capture_logs() as logs:
        site.look(minutes=24 * 60)
        site.look()
    assert [one["event"] for one in logs] == ["snapshots_wait"]
    site.refusal = ""
    site.look()
    assert [source for _, _, source in site.stored] == [END_OF_DAY], "the day is still to be closed"
