"""From a sensing PC's publish to a subtask's read: 1000 updates/s over 50 records, while a second process reads.

The floor is the p99 of one plain hop from publisher to reader in the same run. All processes are the real ones, with
the demo's embedded store.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from collections.abc import Iterable
from pathlib import Path

import yaml

from bench.runner import Figure
from conftest import Mesh, claimed_domain, ports_of, site_data

RECORDS, RATE, SECONDS = 50, 1000, 10
TOPIC = "/bench/reading"
HERE = Path(__file__).resolve().parent


def measure() -> Iterable[Figure]:
    with claimed_domain() as domain, tempfile.TemporaryDirectory() as folder:
        mesh = prepared(Path(folder), domain)
        try:
            mesh.tms("up")
            mesh.tms("param", "load", str(Path(folder) / "records.yaml"))
            found = side_by_side(mesh)
        finally:
            mesh.tms("down")
    yield Figure("publish to read", "ms", found["p99"], 50.0, found["hop"], usual_floor=5.0)
    yield Figure("lost", "", found["lost"], 0.5)


def prepared(folder: Path, domain: int) -> Mesh:
    services = {"db": {}, "sp": {}, "host": {}}
    site = site_data(domain, ports_of(domain), services=services, machines={}, sensing="sensing.yaml")
    given = {"topic": TOPIC, "type": "sensing_msgs/msg/ExcavateSimple", "depth": 200}
    records = [
        {"model_name": "bench", "record_name": f"r{i}", "type": "dynamic", "x": 0.0, "y": 0.0, "z": 0.0}
        for i in range(RECORDS)
    ]
    (folder / "site.yaml").write_text(yaml.safe_dump(site))
    (folder / "sensing.yaml").write_text(yaml.safe_dump({"inputs": {"reading": given}}))
    (folder / "records.yaml").write_text(yaml.safe_dump(records))
    return Mesh(folder / "site.yaml", folder / "state")


def side_by_side(mesh: Mesh) -> dict[str, float]:
    """The publisher and the reader, each a process of its own."""
    words = [sys.executable, "-m", "bench.load.sensing"]
    environment = {**mesh.env, "PYTHONPATH": f"{HERE.parent}:{HERE.parents[1] / 'services'}"}
    with subprocess.Popen([*words, "publish"], env=environment, stdout=subprocess.PIPE, text=True) as publisher:
        reader = subprocess.run([*words, "read"], env=environment, stdout=subprocess.PIPE, text=True, check=True)
        published, _ = publisher.communicate(timeout=60)
    last = json.loads(published)
    final = subprocess.run([*words, "final"], env=environment, stdout=subprocess.PIPE, text=True, check=True)
    stored = json.loads(final.stdout)
    lost = sum(stored[name] != number for name, number in last.items())
    return {**json.loads(reader.stdout), "lost": float(lost)}
