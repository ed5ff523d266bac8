"""Reads the scene records of a machine from the database, for each plan anew."""

import math
from collections.abc import Mapping

from tms_msg_db.msg import Record
from tms_msg_db.srv import ListParameters

from tms_config.clock import unix_time
from tms_machine import stamps
from tms_machine.asking import ask
from tms_machine.reasons import BadRecord
from tms_machine.values import Value, from_parameters
from tms_reason.errors import RosError, SubtaskFailed
from tms_rp.meshes import Mesh
from tms_rp.reasons import MeshAsFile, MeshSimplified, SceneUnread
from tms_rp.scene import Scene
from tms_rp.scene_records import PREFIX, SceneRecord
from tms_rp.scene_roots import SceneRoot
from tms_rp.scene_view import Area, areas
from tms_rp.told_mesh import VERTICES, surface
from tms_runtime.app import App

SERVICE = "/tms/db/list_parameters"
AS_FILE = "mesh"  # type of records of the C++ system with a surface as `data`, which no message brings here
LIMIT = 0.8  # s for the database to answer


class ToldScene:
    """What the records of one machine tell. While the database is away, what they told last, which gets older."""

    def __init__(self, app: App) -> None:
        self._app = app
        self._models = {one.model: app.site.model_of(name) for name, one in app.site.file.machines.items()}
        self._models |= {name: app.site.model_of(name) for name in app.site.file.machines}
        self._links = {"base_link", *(origin.child for origin in app.site.model_of(app.machine).geometry.values())}
        self._records: list[Record] = []
        self._meshes: dict[str, tuple[float, Mesh | None]] = {}  # by record: stamp of its values, surface
        app.ros.prepare(ListParameters, SERVICE)

    def scene(self) -> Scene:
        """What stands there now.

        Raises:
            SubtaskFailed: BadRecord, SceneRecordOld.
        """
        if self._app.ros.has_service(ListParameters, SERVICE):
            self._read()
        values = {one.record_name: from_parameters(one.values) for one in self._records}
        roots = [SceneRoot(name, told) for name, told in values.items() if SceneRoot.holds(told)]
        wanted = {name for name in values if name.startswith(PREFIX)} - {root.name for root in roots}
        wanted |= {name for root in roots for name in root.names(values)}
        now = unix_time()
        found = [
            obstacle
            for one in self._records if one.record_name in wanted
            for obstacle in self._record(one, values[one.record_name], now).obstacles(self._models)
        ]  # fmt: skip
        padding = [item for root in roots for item in root.padding(self._links).items()]
        return Scene(
            tuple(found), tuple({link: max(m for one, m in padding if one == link) for link, _ in padding}.items())
        )

    def areas(self) -> list[Area]:
        """Where the records that were read last say that the machine is to work."""
        return areas({one.record_name: from_parameters(one.values) for one in self._records})

    def _record(self, message: Record, values: Mapping[str, Value], now: float) -> SceneRecord:
        if message.type == AS_FILE and VERTICES not in values:
            raise SubtaskFailed(BadRecord(message.record_name, MeshAsFile()))
        age = now - stamps.seconds(message.updated_at)
        mesh = self._mesh(message.record_name, stamps.seconds(message.updated_at), values)
        return SceneRecord(message.record_name, values, age, message.max_age, message.type == "dynamic", mesh)

    def _mesh(self, name: str, stamp: float, values: Mapping[str, Value]) -> Mesh | None:
        """The surface of a record, made once for each of its changes."""
        if self._meshes.get(name, (math.nan, None))[0] != stamp:
            told = surface(name, values)
            self._meshes[name] = stamp, told and told[0]
            if told is not None and len(told[0].faces) < told[1]:
                why = MeshSimplified(name, told[1], len(told[0].faces), told[0].off)
                self._app.log.warning("mesh_simplified", reason=why)
        return self._meshes[name][1]

    def _read(self) -> None:
        request = ListParameters.Request(model_name=self._app.machine)
        try:
            self._records = list(ask(self._app.ros, ListParameters, SERVICE, request, LIMIT).records)
        except RosError as error:
            self._app.log.warning("scene_unread", reason=SceneUnread(error.reason))
