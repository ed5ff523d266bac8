"""Sockets for Groot: one set of ports per run, served by a thread that only reads the tree."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager

import zmq

from tms_config.clock import monotonic, unix_time
from tms_runtime.log import Logger
from tms_ts.bt.node import Node
from tms_ts.bt.status import IDLE, Status
from tms_ts.bt.tree import Tree
from tms_ts.groot.groot1 import Transition, message, tree_reply
from tms_ts.groot.groot2 import Groot2

STEP = 10  # ports from one run to the next
MAX_RUNS = 10
MESSAGE_PERIOD = 0.04  # s between messages: the library's 25 a second
MAX_CHANGES = 10_000  # kept for one message; a tree that spins makes more than a person can see


class Monitors:
    """Gives every run the lowest free set of ports."""

    def __init__(self, log: Logger, bind: str, first_port: int) -> None:
        self._log, self._bind, self._first = log, bind, first_port
        self._used: set[int] = set()
        self._lock = threading.Lock()

    @contextmanager
    def watch(self, run_id: str, tree: Tree) -> Iterator[None]:
        """Let Groot show a tree; an error ends the view, never the run."""
        with self._lock:
            slot = next((slot for slot in range(MAX_RUNS) if slot not in self._used), None)
            if slot is not None:
                self._used.add(slot)
        monitor = None
        try:
            monitor = None if slot is None else self._open(run_id, tree, self._first + slot * STEP)
            yield
        finally:
            if monitor is not None:
                monitor.close()
            with self._lock:
                self._used.discard(-1 if slot is None else slot)

    def _open(self, run_id: str, tree: Tree, port: int) -> Monitor | None:
        try:
            monitor = Monitor(tree, self._bind, port)
        except (zmq.ZMQError, ValueError) as error:  # a port is in use, or a document cannot have this ID
            self._log.warning("no_groot", run=run_id, port=port, reason=str(error))
            return None
        self._log.info("groot", run=run_id, groot1=port, groot2=port + 2)
        return monitor


class Monitor:
    """port: Groot 1 publisher, +1: its server, +2: Groot 2's server, +3: Groot 2's notices (never any)."""

    def __init__(self, tree: Tree, bind: str, port: int) -> None:
        self._tree = tree
        self._changes: deque[Transition] = deque(maxlen=MAX_CHANGES)
        self._flooded = False
        self._states = {node.uid: int(node.state) for node in tree.nodes}  # at the last message
        self._before: dict[int, int] = {}  # last state that was not idle
        self._groot2 = Groot2(tree)
        self._context = zmq.Context(io_threads=1)
        self._sockets: list[zmq.Socket[bytes]] = []
        try:
            for more, kind in enumerate((zmq.PUB, zmq.REP, zmq.REP, zmq.PUB)):
                self._sockets.append(self._bound(kind, bind, port + more))
        except zmq.ZMQError:
            self._context.destroy(linger=0)
            raise
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._serve, name="groot", daemon=True)
        tree.observers.append(self._changed)
        self._thread.start()

    def close(self) -> None:
        """Send the last changes and close the ports."""
        if self._changed in self._tree.observers:
            self._tree.observers.remove(self._changed)
        self._closing.set()
        self._thread.join(2.0)

    def _bound(self, kind: int, bind: str, port: int) -> zmq.Socket[bytes]:
        socket = self._context.socket(kind)
        socket.linger = 100  # ms
        socket.sndhwm = 100  # messages for a viewer that does not read
        socket.maxmsgsize = 65_536  # bytes of a request
        if ":" in bind:
            socket.ipv6 = True
        try:
            socket.bind(f"tcp://[{bind}]:{port}" if ":" in bind else f"tcp://{bind}:{port}")
        except zmq.ZMQError:
            socket.close(0)
            raise
        return socket

    def _changed(self, node: Node, old: Status, new: Status) -> None:
        """Note a change, and do no more: this runs on the run's thread."""
        if len(self._changes) == MAX_CHANGES:
            self._flooded = True
        self._changes.append((unix_time(), node.uid, int(old), int(new)))

    # the thread

    def _serve(self) -> None:
        publisher, server1, server2, _ = self._sockets
        poller = zmq.Poller()
        poller.register(server1, zmq.POLLIN)
        poller.register(server2, zmq.POLLIN)
        due = monotonic()
        try:
            while not self._closing.is_set():
                wait = max(0.0, due - monotonic())
                ready = dict(poller.poll(round(wait * 1000)))
                if server1 in ready:
                    server1.recv_multipart()
                    server1.send(tree_reply(self._tree, self._states))
                if server2 in ready:
                    frames = server2.recv_multipart()
                    server2.send_multipart(self._groot2.answer(frames, self._states, self._before))
                if monotonic() >= due:
                    self._publish(publisher)
                    due = monotonic() + MESSAGE_PERIOD
            self._publish(publisher)
        finally:
            self._context.destroy(linger=100)

    def _publish(self, publisher: zmq.Socket[bytes]) -> None:
        changes: list[Transition] = []
        while self._changes and len(changes) < MAX_CHANGES:
            changes.append(self._changes.popleft())
        if not changes:
            return
        publisher.send(message(self._states, changes), zmq.NOBLOCK)
        for _, uid, old, new in changes:
            self._states[uid] = new
            if new == IDLE and old != IDLE:
                self._before[uid] = old
        if self._flooded:  # changes were lost; the states of the tree are right again
            self._flooded = False
            self._states.update({node.uid: int(node.state) for node in self._tree.nodes})
