"""Groot's protocols: what the C library sends for the same tree, and what a viewer gets over real sockets."""

import itertools
import json
import socket
import struct
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import msgpack
import pytest
import structlog
import zmq
from lxml import etree

from conformance.scripted import scripted_registry
from conftest import ports_of
from tms_ts.bt import IDLE, RUNNING, SUCCESS, Tree, load
from tms_ts.groot import groot1
from tms_ts.groot.groot2 import Groot2
from tms_ts.groot.monitor import Monitor, Monitors
from unit.tms_ts import groot_client

GOLDEN = json.loads((Path(__file__).parents[2] / "conformance" / "groot1_golden.json").read_text())
SLOW = '<root main_tree_to_execute="M"><BehaviorTree ID="M"><Sequence name="all"><SetBlackboard output_key="k" ' \
       'value="7"/><SubTree ID="S" k="k"/></Sequence></BehaviorTree><BehaviorTree ID="S"><Delay delay_msec="60000">' \
       "<AlwaysSuccess/></Delay></BehaviorTree></root>"  # fmt: skip


@pytest.fixture
def port(own_domain: int) -> int:
    """First of twenty free ports that no other test takes meanwhile; those of a test before may not be free yet."""
    begin = ports_of(own_domain)
    for first in range(begin, begin + 220, 20):
        found = [socket.socket() for _ in range(20)]
        try:
            for more, one in enumerate(found):
                one.bind(("127.0.0.1", first + more))
        except OSError:
            continue
        else:
            return first
        finally:
            for one in found:
                one.close()
    raise AssertionError("no free ports")


@pytest.fixture
def viewer() -> Iterator[zmq.Context[Any]]:
    with zmq.Context() as context:
        yield context
        context.destroy(linger=0)


def ask(viewer: zmq.Context[Any], port: int, *frames: bytes) -> list[bytes]:
    with viewer.socket(zmq.REQ) as request:
        request.connect(f"tcp://127.0.0.1:{port}")
        request.send_multipart(frames)
        assert request.poll(10_000), "no answer"
        answer: list[bytes] = request.recv_multipart()
        return answer


# the bytes


def test_the_golden_reply_reads_as_recorded() -> None:
    assert groot_client.tree(bytes.fromhex(GOLDEN["tree_reply_hex"])) == GOLDEN["tree_decoded"]


def test_our_reply_says_the_same_of_the_same_tree() -> None:
    one = load(GOLDEN["xml"], registry=scripted_registry())
    found = groot_client.tree(groot1.tree_reply(one, {}))
    shift = found["root_uid"] - GOLDEN["tree_decoded"]["root_uid"]
    assert len(found["nodes"]) == len(GOLDEN["tree_decoded"]["nodes"])
    for ours, theirs in zip(found["nodes"], GOLDEN["tree_decoded"]["nodes"], strict=True):
        assert ours["uid"] == theirs["uid"] + shift
        assert ours["children_uid"] == [uid + shift for uid in theirs["children_uid"]]
        for key in ("status", "instance_name", "registration_name"):
            assert ours[key] == theirs[key]
        assert sorted(ours["port_remaps"]) == sorted(theirs["port_remaps"])
    types = {model["registration_name"]: model for model in found["node_models"]}
    assert {node["registration_name"] for node in found["nodes"]} <= types.keys()
    for theirs in GOLDEN["tree_decoded"]["node_models"]:
        ours = types.get(theirs["registration_name"])
        if ours is None or theirs["registration_name"].startswith("Scripted"):
            continue  # a test node that this tree does not use
        assert ours["type"] == theirs["type"], theirs["registration_name"]
        assert {(p["port_name"], p["direction"], p["type_info"]) for p in ours["ports"]} == {
            (p["port_name"], p["direction"], p["type_info"]) for p in theirs["ports"]
        }, theirs["registration_name"]


def test_both_groots_see_the_nodes_of_templates() -> None:
    calls = '<root><BehaviorTree ID="M"><Action ID="ExecuteSubtask" subtask_name="T" a="7"/></BehaviorTree></root>'
    template = '<root><BehaviorTree ID="B"><Delay delay_msec="$a$"><AlwaysSuccess/></Delay></BehaviorTree></root>'
    one = load(calls, templates={"T": template}.get)
    nodes = groot_client.tree(groot1.tree_reply(one, {}))["nodes"]
    assert [(node["registration_name"], node["port_remaps"]) for node in nodes] == [
        ("Delay", [["delay_msec", "7"]]), ("AlwaysSuccess", []),
    ]  # fmt: skip
    _, document = Groot2(one).answer([struct.pack("<BBI", 2, ord("T"), 1)], {}, {})
    (delay,) = etree.fromstring(document).find("BehaviorTree")
    assert (delay.tag, delay.get("delay_msec"), [child.tag for child in delay]) == ("Delay", "7", ["AlwaysSuccess"])


@pytest.mark.parametrize("golden", GOLDEN["messages"])
def test_messages_are_the_golden_bytes(golden: dict[str, Any]) -> None:
    data, reported = bytes.fromhex(golden["hex"]), golden["decoded"]
    changes = [(t["sec"] + t["usec"] * 1e-6, t["uid"], t["prev"], t["status"]) for t in reported["transitions"]]
    assert groot1.message(dict(reported["status"]), changes) == data


# the sockets


def test_groot1_sees_the_tree_and_every_change(port: int, viewer: zmq.Context[Any]) -> None:
    one = load(SLOW)
    monitor = Monitor(one, "127.0.0.1", port)
    with viewer.socket(zmq.SUB) as news:
        news.subscribe(b"")
        news.connect(f"tcp://127.0.0.1:{port}")
        _until_connected(one, news)
        assert one.tick() is RUNNING
        states: dict[int, int] = {}
        while states.get(one.root.uid) != RUNNING:
            assert news.poll(10_000), "no message"
            states, changes = groot_client.message(news.recv())
            for _, uid, _, new in changes:
                states[uid] = new
        reply = groot_client.tree(ask(viewer, port + 1, b"")[0])
        assert {node["uid"]: node["status"] for node in reply["nodes"]} == states
        assert [node["status"] for node in reply["nodes"]] == [RUNNING, SUCCESS, RUNNING, RUNNING, IDLE]
        one.halt()
        monitor.close()
        last: dict[int, int] = {}
        while news.poll(1000):  # the last changes are sent at the end
            last, changes = groot_client.message(news.recv())
            for _, uid, _, new in changes:
                last[uid] = new
    assert set(last.values()) == {IDLE}


def _until_connected(one: Tree, news: zmq.Socket[Any]) -> None:
    """A subscriber hears nothing of what was sent before it had connected: change something until it hears."""
    states = itertools.cycle((RUNNING, IDLE))
    deadline = time.monotonic() + 10
    while not news.poll(100):
        assert time.monotonic() < deadline
        one.nodes[-1].set_state(next(states))
    one.nodes[-1].set_state(IDLE)


def test_groot2_tree_states_and_blackboard(port: int, viewer: zmq.Context[Any]) -> None:
    one = load(SLOW)
    monitor = Monitor(one, "127.0.0.1", port)
    try:
        one.tick()
        head, xml = ask(viewer, port + 2, struct.pack("<BBI", 2, ord("T"), 77))
        assert struct.unpack("<BBI", head[:6]) == (2, ord("T"), 77)
        assert len(head) == 22
        root = etree.fromstring(xml)
        assert root.get("BTCPP_format") == "4"
        main, inner = root.findall("BehaviorTree")
        assert (main.get("ID"), main.get("_fullpath"), inner.get("ID")) == ("M", "", "S")
        use = main.find(".//SubTree")
        assert use.get("_fullpath") == inner.get("_fullpath")
        uids = {int(node.get("_uid")) for node in root.iter() if node.get("_uid")}
        assert uids == {node.uid for node in one.nodes}
        known = {entry.get("ID") for entry in root.find("TreeNodesModel")}
        assert {"Sequence", "SubTree", "WaitForClick", "LeafNodeZx200", "SequenceWithMemory"} <= known

        deadline = time.monotonic() + 10
        while True:  # changes are taken up every 40 ms
            _, block = ask(viewer, port + 2, struct.pack("<BBI", 2, ord("S"), 1))
            states = dict(struct.iter_unpack("<HB", block))
            if states[one.root.uid] == RUNNING or time.monotonic() > deadline:
                break
        assert states == {node.uid: node.state for node in one.nodes}

        _, boards = ask(viewer, port + 2, struct.pack("<BBI", 2, ord("B"), 2), f"M;{inner.get('_fullpath')};X".encode())
        assert msgpack.unpackb(boards)["M"] == {"k": "7"}
        assert set(msgpack.unpackb(boards)) == {"M", inner.get("_fullpath")}
    finally:
        monitor.close()


@pytest.mark.parametrize(
    "frames", [(b"",), (b"123",), (struct.pack("<BBI", 9, 84, 1),), (struct.pack("<BBI", 2, 73, 1),)]
)
def test_groot2_refuses_what_it_does_not_serve(port: int, viewer: zmq.Context[Any], frames: tuple[bytes, ...]) -> None:
    monitor = Monitor(load(SLOW), "127.0.0.1", port)
    try:
        word, text = ask(viewer, port + 2, *frames)
        assert word == b"error"
        assert text
    finally:
        monitor.close()


def test_a_finished_node_shows_how_it_ended(port: int, viewer: zmq.Context[Any]) -> None:
    one = load('<root main_tree_to_execute="M"><BehaviorTree ID="M"><AlwaysSuccess/></BehaviorTree></root>')
    monitor = Monitor(one, "127.0.0.1", port)
    try:
        assert one.tick() is SUCCESS
        states: dict[int, int] = {}
        deadline = time.monotonic() + 10
        while states.get(one.root.uid) != 12 and time.monotonic() < deadline:
            _, block = ask(viewer, port + 2, struct.pack("<BBI", 2, ord("S"), 1))
            states = dict(struct.iter_unpack("<HB", block))
        assert states == {one.root.uid: 12}  # idle, was SUCCESS
    finally:
        monitor.close()


# ports


def test_every_run_has_ports_of_its_own(port: int, viewer: zmq.Context[Any], caplog: pytest.LogCaptureFixture) -> None:
    monitors = Monitors(structlog.stdlib.get_logger("test"), "127.0.0.1", port)
    first, second = load(SLOW), load(SLOW)
    with monitors.watch("r-1", first):
        with monitors.watch("r-2", second):
            roots = [groot_client.tree(ask(viewer, port + 1 + more, b"")[0])["root_uid"] for more in (0, 10)]
            assert roots == [first.root.uid, second.root.uid]
        with monitors.watch("r-3", second):  # the ports are free again
            assert groot_client.tree(ask(viewer, port + 11, b"")[0])["root_uid"] == second.root.uid
    assert not first.observers
    assert not second.observers


def test_a_taken_port_costs_the_view_only(port: int, caplog: pytest.LogCaptureFixture) -> None:
    one = load(SLOW)
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", port + 1))
        taken.listen()
        with Monitors(structlog.stdlib.get_logger("test"), "127.0.0.1", port).watch("r-1", one):
            assert not one.observers
            assert one.tick() is RUNNING
    assert "no_groot" in caplog.text


@pytest.mark.parametrize("name", ["2nd_LeafNode", "zx200 boom up"])
def test_an_id_that_can_be_no_tag_is_shown_in_the_explicit_form(name: str) -> None:
    ports = "".join(f'<input_port name="{port}"/>' for port in ("model_name", "record_name", "subtask_name"))
    one = load(
        f'<root main_tree_to_execute="M"><BehaviorTree ID="M"><Action ID="{name}" name="x" model_name="zx200" '
        f'record_name="r" subtask_name="s"/></BehaviorTree><TreeNodesModel><Action ID="{name}">{ports}</Action>'
        "</TreeNodesModel></root>"
    )
    _, xml = Groot2(one).answer([struct.pack("<BBI", 2, ord("T"), 1)], {}, {})
    shown = etree.fromstring(xml).find("BehaviorTree/Action")
    assert (shown.get("ID"), shown.get("name"), shown.get("record_name")) == (name, "x", "r")
    assert load(xml.replace(b"_uid", b"_description").replace(b"_fullpath", b"name")).root.registration_name == name


def test_a_tree_that_cannot_be_shown_costs_the_view_only(
    port: int, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    def fail(tree: Tree) -> None:
        raise ValueError("no such shape")

    monkeypatch.setattr("tms_ts.groot.monitor.Groot2", fail)
    monitors = Monitors(structlog.stdlib.get_logger("test"), "127.0.0.1", port)
    with monitors.watch("r-1", load(SLOW)):
        assert "no such shape" in caplog.text
    assert not monitors._used


def test_ports_are_free_again_however_the_view_fails(port: int, monkeypatch: pytest.MonkeyPatch) -> None:
    def end(*_: object) -> None:
        raise KeyboardInterrupt

    monitors = Monitors(structlog.stdlib.get_logger("test"), "127.0.0.1", port)
    monkeypatch.setattr(monitors, "_open", end)
    with pytest.raises(KeyboardInterrupt), monitors.watch("r-1", load(SLOW)):
        pass
    assert not monitors._used
