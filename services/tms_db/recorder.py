"""Records joints, poses and loads of the site's machines while a run is active, and some seconds longer.

Nothing is subscribed to while no run is active, as joint states of ten machines cost more than all else that an idle
tms:db does. Messages are sampled, so none wakes the thread that answers services.
"""

import math
import threading
from collections import deque
from collections.abc import Callable, Iterator
from datetime import datetime
from typing import Any

from prometheus_client import Counter, Gauge
from tms_msg_ground.msg import SoilLoad

from tms_config.clock import monotonic, utc_now
from tms_config.config import Site
from tms_db.connection import StoreConnection
from tms_db.recording_piece import COLUMNS, JOINTS, LOAD, POSE, Piece
from tms_db.recordings import PIECE, TAIL, Recordings
from tms_db.store import Db
from tms_db.worker import Worker
from tms_machine.joint_states import JointStates
from tms_machine.places import Places
from tms_reason.errors import DbError
from tms_ros.node import Ros
from tms_runtime.app import App
from tms_runtime.log import Logger
from tms_schedulers.hearing import sample_runs

LOOK = 0.5  # s between looks for an active run
TICK = 0.1  # s between rows of joints
POSES, LOADS = 2, 10  # ticks between rows of poses and of loads
WAITING = 4 * 2**20  # bytes of pieces that wait for the store: an hour of ten machines
AT_ONCE = 50  # pieces between two looks at what waits
AGAIN = 2.0  # s until pieces that the store did not take are sent again
END_LIMIT = 1.0  # s for the last pieces at the end

ACTIVE = Gauge("tms_db_recording", "1 while machines are recorded")
STORED = Counter("tms_db_recording_pieces", "Pieces of recordings that were stored")
DROPPED = Counter("tms_db_recording_dropped", "Pieces of recordings lost, as too many waited for the store")

Row = tuple[str, tuple[str, ...], tuple[float, ...]]  # kind, names, values


class Hearing:
    """The topics of all machines, as long as somebody records."""

    def __init__(self, ros: Ros, site: Site) -> None:
        self._ros = ros
        before = set(ros.node.subscriptions)
        names = list(site.file.machines)
        borders = {name: site.border(name) for name in names}
        self._places = Places(ros, borders)
        self._driven = {name: tuple(site.model_of(name).driven) for name in names if borders[name].joint_states}
        self._joints = {name: JointStates(ros, name, borders[name], of) for name, of in self._driven.items()}
        loads = names if site.file.ground is not None else []
        self._loads: dict[str, Callable[[], list[SoilLoad]]] = {
            name: ros.sample(SoilLoad, f"/{name}/soil_load") for name in loads
        }
        self._made = set(ros.node.subscriptions) - before  # nothing else in this process subscribes while it runs

    def end(self) -> None:
        """Unsubscribe; `take` must not be called any more."""
        made, self._made = self._made, set()

        def leave() -> None:
            for one in made:
                self._ros.node.destroy_subscription(one)

        self._ros.on_executor(leave)

    def take(self, tick: int) -> Iterator[tuple[str, Row]]:
        """Machines with what they have told since the tick before."""
        for name, joints in self._joints.items():
            joints.take()
            for angles in joints.new[-1:]:
                yield name, (JOINTS, self._driven[name], angles)
        for name in self._places.take() if tick % POSES == 0 else ():
            if (at := self._places.place(name)) is not None:
                yield name, (POSE, COLUMNS[POSE], (at.x, at.y, at.yaw))
        for name, new in self._loads.items() if tick % LOADS == 0 else ():
            for load in new():
                values = load.mass, load.bank, load.loose
                if all(map(math.isfinite, values)):
                    yield name, (LOAD, COLUMNS[LOAD], values)


class Pieces:
    """Pieces that wait for the store, the oldest first, and the thread that stores them."""

    def __init__(self, db: Db, connection: StoreConnection, log: Logger) -> None:
        self._recordings, self._connection, self._log = Recordings(db), connection, log
        self._lock = threading.Lock()
        self._waiting: deque[tuple[dict[str, Any], int]] = deque()  # with their bytes
        self._bytes = 0
        self.worker = Worker("recording", self._write, first=math.inf, finish=True)

    def put(self, piece: Piece) -> None:
        """Have a piece stored; where too many wait, the oldest are lost."""
        document = piece.document()
        if document is None:
            return
        size = sum(len(one["data"]) for one in document["series"].values())
        with self._lock:
            self._waiting.append((document, size))
            self._bytes += size
            while self._bytes > WAITING:
                self._bytes -= self._waiting.popleft()[1]
                DROPPED.inc()
        self.worker.wake()

    def _write(self) -> float:
        while True:
            with self._lock:
                some = [self._waiting[i] for i in range(min(AT_ONCE, len(self._waiting)))]
            if not some:
                return math.inf
            try:
                with self._connection.use():
                    self._recordings.write(document for document, _ in some)
            except DbError as error:
                if error.code != "STORE_DOWN":  # which the connection logs
                    self._log.warning("recording_waits", code=error.code, reason=error.reason)
                return AGAIN
            STORED.inc(len(some))
            self._stored(some)

    def _stored(self, some: list[tuple[dict[str, Any], int]]) -> None:
        done = {id(document) for document, _ in some}
        with self._lock:  # some may have been dropped meanwhile
            while self._waiting and id(self._waiting[0][0]) in done:
                self._bytes -= self._waiting.popleft()[1]


class Recorder:
    """Looks for active runs and records while there are any."""

    def __init__(self, app: App, db: Db, connection: StoreConnection) -> None:
        self._ros, self._site = app.ros, app.site
        self.pieces = Pieces(db, connection, app.log)
        self._runs = sample_runs(app.ros, app.site)
        self._until = -math.inf  # s, monotonic
        self._hearing: Hearing | None = None
        self._active = False
        self._ticks = 0
        self._open: dict[str, Piece] = {}
        self._worker = Worker("recorder", self._step, finish=True)

    def start(self) -> None:
        self.pieces.worker.start()
        self._worker.start()

    def stop(self) -> None:
        """Store what there is, and end."""
        self._worker.stop(END_LIMIT)
        self.pieces.worker.stop(END_LIMIT)

    def _step(self) -> float:
        now = monotonic()
        if (told := self._runs()) is not None:
            self._until = now + TAIL if told.runs else self._until
            if self._active and not told.runs:
                self._put_all()  # so that the recording of a run is there when the run is over
            self._active = bool(told.runs)
        if now >= self._until or self._worker.stopping:
            self._end()
            return LOOK
        if self._hearing is None:
            self._hearing = Hearing(self._ros, self._site)
            ACTIVE.set(1)
        for name, (kind, names, values) in self._hearing.take(self._ticks):
            self._piece(name, now).add(kind, names, now, values)
        self._ticks += 1
        return max(0.0, now + TICK - monotonic())

    def _piece(self, machine: str, now: float) -> Piece:
        piece = self._open.get(machine)
        if piece is None or now - piece.since >= PIECE:
            if piece is not None:
                self.pieces.put(piece)
            piece = self._open[machine] = Piece(machine, _milliseconds(utc_now()), now)
        return piece

    def _end(self) -> None:
        if self._hearing is None:
            return
        self._hearing.end()
        self._hearing = None
        ACTIVE.set(0)
        self._put_all()

    def _put_all(self) -> None:
        for piece in self._open.values():
            self.pieces.put(piece)
        self._open = {}


def _milliseconds(time: datetime) -> datetime:
    return time.replace(microsecond=time.microsecond // 1000 * 1000)
