"""A zx200 and two trucks move the earth of a job, ten times as fast as real ones; no bucket counts twice."""

import json
import os
from collections.abc import Iterator
from pathlib import Path

import pytest
import yaml

from conftest import NO_CONSOLE, PROJECT, Mesh, ports_of, running, site_data

pytestmark = [pytest.mark.system, pytest.mark.timeout(300)]
SPEED = 10.0  # times real time
VOLUME = float(os.environ.get("TMS_EARTH", "12"))  # m3 as it lay
RECORDS = ("zx200", "shared", "earthwork")
MACHINES = {
    "zx200": {"model": "zx200"},
    "ic120_1": {"model": "ic120", "start": [-9.3, -15.0, 1.5708]},
    "ic120_2": {"model": "ic120", "start": [-9.3, -22.0, 1.5708]},
}
BUCKET = (0.4, 0.75)  # m3 as it lay: 0.5 to 0.95 loose


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
        made.tms("task", "add", str(PROJECT / "configs" / "tasks" / "load_trucks_until_full.xml"))
        yield made


def job(mesh: Mesh) -> dict[str, float]:
    rows = json.loads(mesh.tms("param", "get", "/EARTHWORK", "--json").stdout)
    values: dict[str, float] = rows["values"]
    return values


def test_two_trucks_move_the_volume_of_the_job(mesh: Mesh) -> None:
    done = mesh.tms("run", "1", "--wait", "--json", expect=None, limit=240)
    answer = json.loads(done.stdout)
    assert answer["outcome"] == "success", answer
    found = job(mesh)
    assert found["done"] and VOLUME <= found["moved"] <= VOLUME + BUCKET[1]
    assert BUCKET[0] <= found["moved"] / found["counted"] <= BUCKET[1]
