"""A job of an excavator and two trucks: what its record says, and that each bucket has counted once."""

import itertools
import json

from conftest import CLI, PROJECT, Mesh, wait_until

MACHINES = {
    "zx200": {"model": "zx200"},
    "ic120_1": {"model": "ic120", "start": [-9.3, -15.0, 1.5708]},
    "ic120_2": {"model": "ic120", "start": [-9.3, -22.0, 1.5708]},
}
GROUND = {"area": [-30.0, -30.0, 10.0, 20.0]}  # m
RECORDS = ("zx200", "shared", "earthwork")
TASK = "load_trucks_until_full"
WIDE = ("area_x=[-22.5, -12.5, -12.5, -22.5]", "area_y=[-18.0, -18.0, -2.0, -2.0]")  # the sample's has about 35 m3
ACTIVE = ("preparing", "running", "stopping", "held")  # states of a run that is not over
BUCKET = 0.75  # m3 as it lay, at most: 0.95 loose
LOST = 2  # sums of the last seconds before tms:db was killed: it keeps the past of records in memory for so long


def prepare(mesh: Mesh, *, wide: bool) -> None:
    """Its records and its task; `wide`: from an area for more than 35 m3."""
    for name in RECORDS:
        mesh.tms("param", "load", str(PROJECT / "configs" / "parameters" / f"{name}.yaml"))
    if wide:
        mesh.tms("param", "set", "zx200/earthwork_two_trucks", *WIDE)
    mesh.tms("task", "add", str(PROJECT / "configs" / "tasks" / f"{TASK}.xml"))


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


def state_of(mesh: Mesh, run: str) -> str:
    """The state of a run; empty while it is not known: a full PC may keep the database from being found in time."""
    told = mesh.tms("runs", "--limit", "5", "--json", expect=None)
    if told.returncode:
        return ""
    return next((row["state"] for row in json.loads(told.stdout) if row["run_id"] == run), "")


def check(mesh: Mesh, volume: float, *, killed: int = 0) -> None:
    """The volume [m3] is moved, by buckets of a usual size, of which each has counted once.

    `killed`: how often tms:db was killed.
    """
    found = job(mesh)
    assert found["done"] and volume <= found["moved"] <= volume + BUCKET, found
    rows = json.loads(mesh.tms("param", "history", "/EARTHWORK", "--limit", "10000", "--json").stdout)
    sums = [row["values"] for row in rows if "counted" in row["values"]]
    counts, moved = zip(*sorted({(int(one["counted"]), one["moved"]) for one in sums}), strict=True)
    assert len(set(counts)) == len(counts), f"one sum a bucket: {counts}"
    steps = [after - before for before, after in itertools.pairwise(counts)]
    assert set(steps) == {1} or sum(steps) - len(steps) <= LOST * killed, f"no bucket is left out: {counts}"
    brought = zip(itertools.pairwise(moved), steps, strict=True)
    assert all(0.0 <= after - before <= step * BUCKET for (before, after), step in brought), moved
