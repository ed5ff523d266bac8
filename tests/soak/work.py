"""The work: job after job of an excavator and two trucks, on a ground that is renewed before it is used up."""

from __future__ import annotations

import json
import time

import area_file
import earth_job
from conftest import Mesh
from soak.kills import Kills

VOLUME = 6.0  # m3 of a job, as it lay: more than one truck takes
JOBS = 5  # on a ground
JOB_LIMIT = 900.0  # s
LOOK = 3.0  # s between two looks at a run
AREAS = {"yard": ("unmanned", [(-60, -60), (60, -60), (60, 60), (-60, 60)])}  # all machines may be anywhere in it


class Failed(Exception):
    """A job did not end well; says how."""


class Work:
    """Its jobs. A run that its scheduler's kill has interrupted is resumed, as a person would."""

    def __init__(self, mesh: Mesh, kills: Kills) -> None:
        self._mesh, self._kills = mesh, kills
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
        earth_job.check(self._mesh, volume, killed=self._kills.count("tms:db"))
        self.jobs += 1

    def _end(self, run: str) -> str:
        """The state in which a run ends."""
        deadline = time.monotonic() + JOB_LIMIT
        while time.monotonic() < deadline:
            time.sleep(LOOK)
            state = earth_job.state_of(self._mesh, run)
            if state == "interrupted":
                self._mesh.arm()
                self._mesh.tms("resume", run, "--yes")
                self.resumed += 1
            elif state and state not in earth_job.ACTIVE:
                return state
        return f"not after {JOB_LIMIT:.0f} s"

    def _renew_ground(self) -> None:
        """Let the ground begin anew, level; the work goes on."""
        self._mesh.wait_ready()
        self._mesh.tms("stop-process", "tms:ground")
        for file in (self._mesh.state / "ground.npz", *self._mesh.state.glob("ground.journal.*")):
            file.unlink(missing_ok=True)
        self._mesh.tms("start", "tms:ground")
        self._kills.restarted("tms:ground")

    def once(self) -> list[str]:
        """What is wrong with the list of all runs."""
        rows = json.loads(self._mesh.tms("runs", "--limit", "1000", "--json").stdout)
        states = sorted(row["state"] for row in rows)
        return [] if states == ["success"] * self.jobs else [f"{self.jobs} jobs, but runs ended as {states}"]


def start(mesh: Mesh) -> None:
    """The site, with its areas enabled, its machines armed, and the records of the job."""
    area_file.up(mesh, AREAS)
    earth_job.prepare(mesh, wide=True)
