"""A zx200 and two trucks move the earth of a job, ten times as fast as real ones; no bucket counts twice."""

import json
import os
import signal
from collections.abc import Iterator
from pathlib import Path

import pytest
import yaml
from test_mesh import processes

import earth_job
from conftest import CLI, NO_CONSOLE, Mesh, ports_of, running, site_data, wait_until
from earth_job import ACTIVE, check, job, state_of

pytestmark = [pytest.mark.turns, pytest.mark.system, pytest.mark.timeout(600)]
SPEED = 10.0  # times real time
VOLUME = float(os.environ.get("TMS_EARTH", "12"))  # m3 as it lay: three loads
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


@pytest.fixture
def mesh(own_domain: int, tmp_path: Path) -> Iterator[Mesh]:
    data = site_data(
        own_domain, ports_of(own_domain), name="earth", machines=earth_job.MACHINES, sim={"speed": SPEED},
        ground=earth_job.GROUND, **NO_CONSOLE,
    )  # fmt: skip
    (tmp_path / "site.yaml").write_text(yaml.safe_dump(data))
    with running(Mesh(tmp_path / "site.yaml", tmp_path / "state")) as made:
        earth_job.prepare(made, wide="TMS_EARTH" in os.environ)
        made.tms("param", "set", "/EARTHWORK", f"volume={VOLUME}")
        yield made


def worked(mesh: Mesh) -> dict[str, float]:
    """The sum of the excavator's cycles."""
    found: dict[str, float] = json.loads(mesh.tms("work", "--machine", "zx200", "--json").stdout)["total"]
    return found


def test_two_trucks_move_the_volume_of_the_job(mesh: Mesh) -> None:
    done = mesh.tms("run", "1", "--wait", "--json", expect=None, limit=560)
    answer = json.loads(done.stdout)
    assert answer["outcome"] == "success", answer
    check(mesh, VOLUME)
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
    wait_until(lambda: state_of(mesh, run_id) not in ("", *ACTIVE), 3000, "the run ends", every=5.0)
    assert state_of(mesh, run_id) == "success", mesh.tms("events", run_id).stdout[-2000:]
    check(mesh, VOLUME, killed=KILLED.count("tms:db"))
