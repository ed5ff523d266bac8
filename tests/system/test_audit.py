"""The audit of a real mesh: its chain survives restarts of the console, and a hand in the database is seen."""

import json
import urllib.error
import urllib.request

import pymongo
import pytest

from conftest import Mesh, wait_until
from tms_config.config import load_site
from tms_db import store_address

pytestmark = [pytest.mark.system, pytest.mark.timeout(300)]


def command(mesh: Mesh, run_id: str) -> None:
    """Cancel a run that is not there: it changes nothing, and is audited."""
    port = load_site(str(mesh.site)).file.ports.console
    url = f"http://127.0.0.1:{port}/api/runs/{run_id}/cancel"
    request = urllib.request.Request(url, b"{}", {"Content-Type": "application/json"})
    with pytest.raises(urllib.error.HTTPError) as refused:
        urllib.request.urlopen(request, timeout=30)
    refused.value.close()
    assert refused.value.code == 404
    wait_until(lambda: run_id in targets(mesh), 30, f"{run_id} is in the database")


def targets(mesh: Mesh) -> list[str]:
    return [row["target"] for row in json.loads(mesh.tms("audit", "list", "--json").stdout)]


def test_the_chain(mesh: Mesh, monkeypatch: pytest.MonkeyPatch) -> None:
    command(mesh, "r-before")
    mesh.tms("restart", "tms:ur")
    mesh.wait_ready()
    command(mesh, "r-behind")
    report = json.loads(mesh.tms("audit", "verify", "--json").stdout)
    assert (report["intact"], report["end_compared"], report["first"]) == (True, True, 1)
    assert report["entries"] == report["last"] >= 2

    monkeypatch.setenv("TMS_STATE", str(mesh.state))
    site = load_site(str(mesh.site))
    with pymongo.MongoClient(store_address.uri(site)) as client:
        events = client[site.file.store.database]["event"]
        entry = events.find_one({"run_id": "audit", "node": "r-before"})
        events.update_one({"_id": entry["_id"]}, {"$set": {"text": "somebody else"}})
        try:
            assert f"entry {entry['number']} was changed" in mesh.tms("audit", "verify", expect=1).stderr
        finally:
            events.update_one({"_id": entry["_id"]}, {"$set": {"text": entry["text"]}})
    mesh.tms("audit", "verify")
