"""A zx200 and two trucks move the earth of a job, ten times as fast as real ones; no bucket counts twice."""

import itertools
import json
import os
import signal
from collections.abc import Iterator
from pathlib import Path

import pytest
import yaml
from test_mesh import processes
from test_stop import state_of

from conftest import CLI, NO_CONSOLE, PROJECT, Mesh, ports_of, running, site_data, wait_until

pytestmark = [pytest.mark.turns, pytest.mark.system, pytest.mark.timeout(600)]
SPEED = 10.0  # times real time
VOLUME = float(os.environ.get("TMS_EARTH", "12"))  # m3 as it lay: three loads
WIDE = ("area_x=[-22.5, -12.5, -12.5, -22.5]", "area_y=[-18.0, -18.0, -2.0, -2.0]")  # the sample's has about 35 m3
RECORDS = ("zx200", "shared", "earthwork")
MACHINES = {
    "zx200": {"model": "zx200"},
    "ic120_1": {"model": "ic120", "start": [-9.3, -15.0, 1.5708]},
    "ic120_2": {"model": "ic120", "start": [-9.3, -22.0, 1.5708]},
}
KILLED = (  # one after the other, a bucket later each
    "zx200:st_zx200_choose_dig_point",
    "zx200:subtask_zx200_excavate_simple",
    "zx200:st_zx200_dig_again_until",
    "zx200:rp",
    "ic120_1:st_ic120_wait_until_loaded",
    "tms:ts",
    "zx200:st_zx200_choose_dump_point",
    "zx200:rc",
    "tms:db",
    "tms:ground",
)
ACTIVE = ("preparing", "running", "stopping", "held")
BUCKET = 0.75  # m3 as it lay, at most: 0.95 loose
LOST = 2  # sums of the last seconds before tms:db was killed: it keeps the past of records in memory for so long


@pytest.fixture
def mesh(own_domain: int, tmp_path: Path) -> Iterator[Mesh]:
    data = site_data(
        own_domain, ports_of(own_domain), name="earth", machines=MACHINES, sim={"speed": SPEED},
        ground={"area": [-30.0, -30.0, 10.0, 20.0]}, **NO_CONSOLE,
    )  # fmt: skip
    (tmp_path / "site.yaml").write_text(yaml.safe_dump(data))
    with running(Mesh(tmp_path / "site.yaml", tmp_path / "state")) as made:
        for name in RECORDS:
            made.tms("param", "load", str(PROJECT / "configs" / "parameters" / f"{name}.yaml"))
        made.tms("param", "set", "/EARTHWORK", f"volume={VOLUME}")
        if "TMS_EARTH" in os.environ:
            made.tms("param", "set", "zx200/earthwork_two_trucks", *WIDE)
        made.tms("task", "add", str(PROJECT / "configs" / "tasks" / "load_trucks_until_full.xml"))
        yield made


def job(mesh: Mesh) -> dict[str, float]:
    """The job's record, once it can be read."""
    found: list[str] = []

    def read() -> bool:
        done = mesh.tms("param", "get", "/EARTHWORK", "--json", expect=None)
        found[:] = [done.stdout]
        return done.returncode == 0

    wait_until(read, 60, "the database answers", every=CLI)
    values: dict[str, float] = json.loads(found[0])["values"]
    return values


def check(mesh: Mesh, *, killed: bool = False) -> None:
    """The volume is moved, by buckets of a usual size, of which each has counted once."""
    found = job(mesh)
    assert found["done"] and VOLUME <= found["moved"] <= VOLUME + BUCKET
    rows = json.loads(mesh.tms("param", "history", "/EARTHWORK", "--limit", "10000", "--json").stdout)
    sums = [row["values"] for row in rows if "counted" in row["values"]]
    counts, moved = zip(*sorted({(int(one["counted"]), one["moved"]) for one in sums}), strict=True)
    assert len(set(counts)) == len(counts), "one sum a bucket"
    steps = [after - before for before, after in itertools.pairwise(counts)]
    assert set(steps) == {1} or (killed and sum(steps) - len(steps) <= LOST), "no bucket is left out"
    brought = zip(itertools.pairwise(moved), steps, strict=True)
    assert all(0.0 <= after - before <= step * BUCKET for (before, after), step in brought)


def worked(mesh: Mesh) -> dict[str, float]:
    """The sum of the excavator's cycles."""
    found: dict[str, float] = json.loads(mesh.tms("work", "--machine", "zx200", "--json").stdout)["total"]
    return found


def ended(mesh: Mesh, run_id: str) -> bool:
    """A full PC may keep the database from being found in time: then it is not known."""
    told = mesh.tms("runs", "--limit", "5", "--json", expect=None)
    return (
        told.returncode == 0
        and next(r["state"] for r in json.loads(told.stdout) if r["run_id"] == run_id) not in ACTIVE
    )


def test_two_trucks_move_the_volume_of_the_job(mesh: Mesh) -> None:
    done = mesh.tms("run", "1", "--wait", "--json", expect=None, limit=560)
    answer = json.loads(done.stdout)
    assert answer["outcome"] == "success", answer
    check(mesh)
    buckets = job(mesh)["counted"]
    wait_until(lambda: worked(mesh)["cycles"] >= buckets, 30, "the last cycle is in the database", every=CLI)
    found = worked(mesh)
    assert found["cycles"] == buckets and found["unseen_s"] == 0.0
    assert found["bank_m3"] == pytest.approx(job(mesh)["moved"], rel=0.1), "some falls beside the vessel"


@pytest.mark.timeout(3600)
@pytest.mark.skipif("TMS_EARTH" not in os.environ, reason="make nightly")
def test_it_goes_on_whatever_is_killed(mesh: Mesh) -> None:
    run_id = json.loads(mesh.tms("run", "1", "--json").stdout)["run_id"]
    for number, name in enumerate(KILLED, 1):
        wait_until(lambda least=number: job(mesh)["counted"] >= least, 300, f"bucket {number} is counted", every=CLI)
        os.kill(processes(mesh)[name]["pid"], signal.SIGKILL)
        if name == "tms:ts":
            wait_until(lambda: state_of(mesh, run_id) == "interrupted", 60, "the run is interrupted", every=CLI)
            mesh.wait_ready()
            mesh.tms("rearm", "--all", "--yes")
            mesh.tms("resume", run_id, "--yes")
    wait_until(lambda: ended(mesh, run_id), 3000, "the run ends", every=5.0)
    assert state_of(mesh, run_id) == "success", mesh.tms("events", run_id).stdout[-2000:]
    check(mesh, killed=True)
