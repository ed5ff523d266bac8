"""A viewer that speaks Groot 1 and one that speaks Groot 2 look at a run of the mesh."""

import json
import struct
import time

import pytest
import zmq
from lxml import etree

from conftest import Mesh
from unit.tms_ts import groot_client

pytestmark = pytest.mark.system
LIMIT = 60.0  # s for whatever must happen at all
RUNNING = 1
SWINGS = "3"


def ask(viewer: "zmq.Context[zmq.Socket[bytes]]", port: int, frame: bytes) -> list[bytes]:
    with viewer.socket(zmq.REQ) as request:
        request.connect(f"tcp://127.0.0.1:{port}")
        request.send(frame)
        assert request.poll(LIMIT * 1000), f"no answer on port {port}"
        answer: list[bytes] = request.recv_multipart()
        return answer


def test_groot_watches_a_run(mesh: Mesh, first_port: int) -> None:
    port = first_port + 60
    with zmq.Context() as viewer, viewer.socket(zmq.SUB) as news:
        news.subscribe(b"")
        news.connect(f"tcp://127.0.0.1:{port}")
        run = json.loads(mesh.tms("run", SWINGS, "--json").stdout)["run_id"]
        try:
            tree = groot_client.tree(ask(viewer, port + 1, b"")[0])
            types = {model["registration_name"] for model in tree["node_models"]}
            assert {node["registration_name"] for node in tree["nodes"]} <= types
            assert "LeafNodeZx200" in types
            uids = {node["uid"] for node in tree["nodes"]}
            states = {node["uid"]: node["status"] for node in tree["nodes"]}
            assert states[tree["root_uid"]] == RUNNING  # present statuses, not those of the beginning

            seen: set[int] = set()
            deadline = time.monotonic() + LIMIT
            while RUNNING not in seen or len(seen) < 2:
                assert time.monotonic() < deadline, seen
                assert news.poll(LIMIT * 1000), "nothing changes"
                before, changes = groot_client.message(news.recv())
                assert before.keys() == uids
                assert changes, "Groot repaints nothing without a transition"
                for stamp, uid, old, new in changes:
                    assert before[uid] == old
                    before[uid] = new
                    assert abs(stamp - time.time()) < LIMIT
                    seen.add(new)

            _, xml = ask(viewer, port + 2, struct.pack("<BBI", 2, ord("T"), 1))
            assert etree.fromstring(xml).get("BTCPP_format") == "4"
        finally:
            mesh.tms("cancel", run)
