"""Tells other processes of the ground: loads, what machines feel of it, and where it has changed."""

from builtin_interfaces.msg import Time
from geometry_msgs.msg import Point, Pose, Quaternion
from prometheus_client import Gauge
from std_msgs.msg import Float64
from tms_msg_ground.msg import GroundContact, HeightPatch, SoilLoad

from tms_control.links import Matrix, quaternion
from tms_ground.watching import GroundWatch
from tms_runtime.app import App
from tms_soil import patches
from tms_soil.load import Load

PATCHES = "/tms/ground/patches"
A_TIME = 4  # patches in one go: up to 64 kB each, where a tile has changed all over
SECOND = 1000  # serials of a second, more than are used: a process that comes next begins with a gap

LOAD = Gauge("tms_ground_load_cubic_metres", "Soil in bucket or vessel, loose, estimated", ["machine"])


class Teller:
    """Publishes what has changed. The volumes are estimates: no machine weighs its soil."""

    def __init__(self, app: App, watch: GroundWatch, feeling: bool) -> None:
        """`feeling`: whether stand-ins are to feel the ground."""
        self._ros, self._watch = app.ros, watch
        loads = watch.loads()
        self._volumes = {name: app.ros.publisher(Float64, f"/{name}/soil_volume", depth=1) for name in loads}
        self._loads = {name: app.ros.publisher(SoilLoad, f"/{name}/soil_load", depth=1, latched=True) for name in loads}
        self._contacts = {
            name: app.ros.publisher(GroundContact, f"/{name}/ground_contact", depth=1, latched=True)
            for name in (watch.earth.bodies if feeling else ())
        }
        self._felt: dict[str, tuple[float, bytes]] = {}  # resistance and place that were told last
        self._patches = app.ros.publisher(HeightPatch, PATCHES, depth=A_TIME)
        self.serial = app.ros.now().sec * SECOND  # of the last patch

    def feel(self, name: str) -> None:
        """Tell a machine what it feels: changes, and a resistance while it lasts, since silence ends it."""
        place = self._watch.stands(name)
        if name not in self._contacts or place is None:
            return
        now = self._watch.earth.bodies[name].resistance, place.tobytes()
        if now[0] or now != self._felt.get(name):
            self._felt[name] = now
            message = GroundContact(stamp=self._ros.now(), resistance=now[0], stands=_pose(place))
            self._contacts[name].publish(message)

    def tell(self, stamp: Time) -> None:
        """Tell all loads, and some of the changes; the ground must not change meanwhile.

        `stamp`: all that machines had told until then is in the ground.
        """
        for name, load in self._watch.loads().items():
            LOAD.labels(name).set(load.loose)
            self._volumes[name].publish(Float64(data=load.loose))
            self._loads[name].publish(SoilLoad(
                stamp=stamp, soil=self._soil(load), mass=load.mass, loose=load.loose, bank=load.bank,
                capacity=load.capacity,
            ))  # fmt: skip
        for bounds in self._watch.changes.take(A_TIME):
            self.serial += 1
            message = patches.patch(self._watch.earth.grid.heights(bounds, side=1), self.serial)
            message.header.stamp = stamp
            self._patches.publish(message)

    def _soil(self, load: Load) -> str:
        return "" if load.kind is None else self._watch.soils[load.kind]


def _pose(place: Matrix) -> Pose:
    x, y, z = place[:3, 3].tolist()
    qx, qy, qz, qw = quaternion(place[:3, :3])
    return Pose(position=Point(x=x, y=y, z=z), orientation=Quaternion(x=qx, y=qy, z=qz, w=qw))
