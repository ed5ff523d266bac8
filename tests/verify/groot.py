"""A viewer that speaks the protocol of Groot 1, with a thread that notes every change of colour."""

from __future__ import annotations

import socket
import threading
import time

import zmq

from unit.tms_ts import groot_client
from verify.colours import GREY, Change, Shape

ASK = 500  # ms for an answer of the server
RECONNECT = 5  # ms between attempts while no run has opened its ports
STEP = 50  # ms after which the thread looks whether it shall end


def listens(port: int) -> bool:
    """Whether somebody listens at a port of this PC."""
    with socket.socket() as caller:
        return caller.connect_ex(("127.0.0.1", port)) == 0


class Viewer:
    """Watches the first run that begins after it was made."""

    def __init__(self, port: int) -> None:
        self._context = zmq.Context()
        self._news = self._context.socket(zmq.SUB)
        self._news.reconnect_ivl = RECONNECT
        self._news.subscribe(b"")
        self._news.connect(f"tcp://127.0.0.1:{port}")
        self._port = port
        self.shape = Shape({})
        self.changes: list[Change] = []
        self._names: dict[int, str] = {}
        self._colours: dict[int, int] = {}
        self._changed, self._closing = threading.Condition(), False
        self._thread = threading.Thread(target=self._watch, name="groot")
        self._thread.start()

    def wait(self, node: str, colour: int, seconds: float) -> bool:
        """Until a node has this colour; False when the run is over before, or the time is."""
        with self._changed:
            self._changed.wait_for(lambda: self.colour(node) == colour or self.over, seconds)
            return self.colour(node) == colour

    def colour(self, node: str) -> int | None:
        """The present colour of a node, None before its first change."""
        return next((change.new for change in reversed(self.changes) if change.node == node), None)

    @property
    def over(self) -> bool:
        """Whether the root is grey again, after a run."""
        return self.colour(next(iter(self.shape.parents), "")) == GREY

    def ended(self, seconds: float) -> bool:
        """Until the run is over; False when the time is over."""
        with self._changed:
            return self._changed.wait_for(lambda: self.over, seconds)

    def delay(self) -> float:
        """The longest time from a change until it was seen [s]."""
        return max((change.seen - change.stamp for change in self.changes), default=0.0)

    def close(self) -> None:
        self._closing = True
        self._thread.join()
        self._context.destroy(linger=0)

    def _watch(self) -> None:
        self._learn(self._ask())
        while not self._closing:
            if self._news.poll(STEP):
                self._note(self._news.recv(), time.time())
            elif not self.changes:
                self._catch_up(self._ask())

    def _ask(self) -> list[groot_client.Tree]:
        """The nodes with their statuses; again where a server has ended meanwhile. Empty when this viewer ends."""
        while not self._closing:
            with self._context.socket(zmq.REQ) as server:
                server.linger, server.reconnect_ivl = 0, RECONNECT
                server.connect(f"tcp://127.0.0.1:{self._port + 1}")
                server.send(b"")
                if server.poll(ASK):
                    nodes: list[groot_client.Tree] = groot_client.tree(server.recv())["nodes"]
                    return nodes
        return []

    def _catch_up(self, nodes: list[groot_client.Tree]) -> None:
        """Note what changed before the publisher knew this viewer, as Groot shows it when it connects."""
        late = [node for node in nodes if node["status"] != GREY]
        if late and not self._news.poll(2 * STEP):
            now = time.time()
            with self._changed:
                for node in late:
                    self._change(node["uid"], GREY, node["status"], now, now)
                self._changed.notify_all()

    def _learn(self, found: list[groot_client.Tree]) -> None:
        nodes = {node["uid"]: node for node in found}
        for uid, node in nodes.items():
            self._names[uid] = dict(node["port_remaps"]).get("record_name") or node["instance_name"]
        parents = dict.fromkeys(self._names.values(), "")
        for uid, node in nodes.items():
            parents |= {self._names[child]: self._names[uid] for child in node["children_uid"]}
        self.shape = Shape(parents)

    def _note(self, message: bytes, now: float) -> None:
        before, changes = groot_client.message(message)
        first = changes[0][0]
        with self._changed:
            for uid, colour in before.items():  # what changed before this viewer was connected
                self._change(uid, self._colours.get(uid, GREY), colour, first, now)
            for stamp, uid, old, new in changes:
                self._change(uid, old, new, stamp, now)
            self._changed.notify_all()

    def _change(self, uid: int, old: int, new: int, stamp: float, now: float) -> None:
        self._colours[uid] = new
        if old != new:
            self.changes.append(Change(self._names[uid], old, new, stamp, now))
