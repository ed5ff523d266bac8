"""The work: job after job of an excavator and two trucks, on a ground that is renewed before it is used up."""

from __future__ import annotations

import json
import time
from collections.abc import Callable

import earth_job
from conftest import CLI, Mesh, wait_until

VOLUME = 6.0  # m3 of a job, as it lay: more than one truck takes
JOBS = 5  # on a ground
JOB_LIMIT = 900.0  # s
LOOK = 3.0  # s between two looks at a run
ACTIVE = ("preparing", "running", "stopping", "held")
YARD = [(-60, -60), (60, -60), (60, 60), (-60, 60), (-60, -60)]  # m


class Failed(Exception):
    """A job did not end well; says how."""


class Work:
    """Its jobs. A run that its scheduler's kill has interrupted is resumed, as a person would."""

    def __init__(self, mesh: Mesh, lost: Callable[[], int]) -> None:
        """`lost`: how often tms:db was killed."""
        self._mesh, self._lost = mesh, lost
        self.jobs = self.resumed = 0

    def job(self) -> None:
        """One more, from the start of its run to a look at what is moved.

        Raises:
            Failed: it did not succeed.
        """
        if self.jobs % JOBS == 0 and self.jobs:
            self._renew_ground()
        volume = VOLUME * (self.jobs + 1)
        self._mesh.wait_ready()
        self._mesh.tms("param", "set", "/EARTHWORK", f"volume={volume}")
        run = json.loads(self._mesh.tms("run", "1", "--json").stdout)["run_id"]
        state = self._end(run)
        if state != "success":
            raise Failed(f"job {self.jobs + 1} ended as {state}: {self._mesh.tms('events', run).stdout[-1500:]}")
        self._mesh.wait_ready()
        earth_job.check(self._mesh, volume, killed=self._lost())
        self.jobs += 1

    def _end(self, run: str) -> str:
        """The state in which a run ends."""
        deadline = time.monotonic() + JOB_LIMIT
        while time.monotonic() < deadline:
            time.sleep(LOOK)
            state = self._state(run)
            if state == "interrupted":
                self._mesh.arm()
                self._mesh.tms("resume", run, "--yes")
                self.resumed += 1
            elif state and state not in ACTIVE:
                return state
        return f"not after {JOB_LIMIT:.0f} s"

    def _state(self, run: str) -> str:
        """Empty while the database does not answer."""
        told = self._mesh.tms("runs", "--limit", "5", "--json", expect=None)
        if told.returncode:
            return ""
        return next((row["state"] for row in json.loads(told.stdout) if row["run_id"] == run), "")

    def _renew_ground(self) -> None:
        """Let the ground begin anew, level; the work goes on."""
        self._mesh.wait_ready()
        self._mesh.tms("stop-process", "tms:ground")
        for file in (self._mesh.state / "ground.npz", *self._mesh.state.glob("ground.journal.*")):
            file.unlink(missing_ok=True)
        self._mesh.tms("start", "tms:ground")

    def once(self) -> list[str]:
        """What is wrong with the list of all runs."""
        rows = json.loads(self._mesh.tms("runs", "--limit", "1000", "--json").stdout)
        states = sorted(row["state"] for row in rows)
        return [] if states == ["success"] * self.jobs else [f"{self.jobs} jobs, but runs ended as {states}"]


def _write_area(mesh: Mesh) -> None:
    """One in which all machines may be."""
    folder = mesh.site.with_suffix("") / "areas"
    folder.mkdir(parents=True)
    feature = {
        "type": "Feature", "properties": {"id": "yard", "type": "unmanned"},
        "geometry": {"type": "Polygon", "coordinates": [YARD]},
    }  # fmt: skip
    (folder / "yard.geojson").write_text(
        json.dumps({"type": "FeatureCollection", "frame": "map", "features": [feature]})
    )


def start(mesh: Mesh) -> None:
    """The site, with its areas enabled and its machines armed."""
    _write_area(mesh)
    mesh.tms("up", "--no-wait")  # without areas it is not ready
    enable = ("areas", "enable", "--yes", "--by", "a person")
    wait_until(lambda: mesh.tms(*enable, expect=None).returncode == 0, 90, "all gateways serve", every=CLI)
    mesh.arm()
    earth_job.prepare(mesh, wide=True)
