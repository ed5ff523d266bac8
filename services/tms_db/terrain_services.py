"""Terrain over ROS with the C++ system's types: images and clouds for readers, dynamic clouds from sensing.

These types have no error fields: a request for terrain that is not stored gets an empty answer and a line in the log.
"""

import math
import threading

from prometheus_client import Counter
from tms_msg_db.msg import TmsdbGridFS
from tms_msg_db.srv import TerrainStaticSrv, TmsdbTerrainImageSrv

from tms_db import store, terrain_messages
from tms_db.connection import StoreConnection
from tms_db.reasons import NoImageType, TerrainOverRos
from tms_db.terrain import Terrain, TerrainFile, missing
from tms_db.terrain_files import IMAGES, bad
from tms_db.worker import Worker
from tms_reason.errors import TmsError
from tms_runtime.app import App

CLOUDS = Counter("tms_db_clouds", "Dynamic terrain that came over ROS", ["what"])
TOPIC = "tms_db_gridfs_data"
NAMES = 20  # names whose clouds may wait for the store


class TerrainServices:
    """Each call reads in a thread of its own; one thread writes the newest cloud of each name."""

    def __init__(self, app: App, db: store.Db, connection: StoreConnection) -> None:
        self._app, self._connection = app, connection
        self._terrain = Terrain(db)
        self._waiting: dict[str, TmsdbGridFS] = {}
        self._lock = threading.Lock()
        self._worker = Worker("terrain", self._write, first=math.inf)

    def offer(self) -> None:
        ros = self._app.ros
        ros.offer_slow(TmsdbTerrainImageSrv, "/tms/db/terrain_image", self.image)
        ros.offer_slow(TerrainStaticSrv, "/tms/db/terrain_cloud", self.cloud)
        ros.subscribe(TmsdbGridFS, f"/{TOPIC}", self.received)
        self._app.on_stop(self._worker.stop)
        self._worker.start()

    def image(
        self, request: TmsdbTerrainImageSrv.Request, response: TmsdbTerrainImageSrv.Response
    ) -> TmsdbTerrainImageSrv.Response:
        """The newest heightmap or colour image, of that name if one is given."""
        try:
            with self._connection.use():
                if request.type not in IMAGES:
                    raise bad(NoImageType(request.type, tuple(IMAGES)))
                found = self._find(request.type, request.filename, request.id)
                response.image = terrain_messages.image(found.filename, self._terrain.read(found))
                response.image.header.stamp = self._app.ros.now()
                response.time, response.type, response.id = found.time, found.type, found.id
                response.filename = found.filename
                response.terrainheight, response.terrainwidth = found.size("height"), found.size("width")
                response.terrainelevation = found.size("elevation")
                response.offset_x, response.offset_y = found.size("offset_x"), found.size("offset_y")
        except TmsError as error:
            self._refused("terrain_image", error)
        return response

    def cloud(
        self, request: TerrainStaticSrv.Request, response: TerrainStaticSrv.Response
    ) -> TerrainStaticSrv.Response:
        """The newest cloud of a type."""
        try:
            with self._connection.use():
                found = self._find(request.type, "", 0)
                data = self._terrain.read(found)
                response.pointcloud2 = terrain_messages.cloud(found.filename, found.more.get("cloud"), data)
        except TmsError as error:
            self._refused("terrain_cloud", error)
        return response

    def received(self, message: TmsdbGridFS) -> None:
        """Take a cloud from sensing; on the executor thread."""
        name = message.filename or message.type
        with self._lock:
            full = len(self._waiting) >= NAMES and name not in self._waiting
            CLOUDS.labels("dropped" if full or name in self._waiting else "taken").inc()
            if not full:
                self._waiting[name] = message
        self._worker.wake()

    def _write(self) -> float:
        with self._lock:
            waiting, self._waiting = self._waiting, {}
        for name, message in waiting.items():
            if self._worker.stopping:
                break
            try:
                with self._connection.use():
                    self._store(name, message)
            except TmsError as error:
                CLOUDS.labels("refused").inc()
                self._refused(TOPIC, error)
        return math.inf

    def _store(self, name: str, message: TmsdbGridFS) -> None:
        if message.type != "dynamic":
            raise bad(TerrainOverRos(name, message.type))
        head = terrain_messages.cloud_head(message.pointcloud2)
        self._terrain.put_dynamic(name, bytes(message.pointcloud2.data), head)

    def _find(self, type_: str, filename: str, id_: int) -> TerrainFile:
        found = self._terrain.find(type_, filename)
        if found is None or (id_ and id_ != found.id):
            raise missing(f"{type_} {filename}".strip())
        return found

    def _refused(self, service: str, error: TmsError) -> None:
        self._app.log.warning("refused", service=service, code=error.code, reason=error.reason)
