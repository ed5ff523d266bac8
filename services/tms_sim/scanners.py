"""Process `sim:scanners`: scanners that see the ground as `tms:ground` keeps it, with noise, shadow and range."""

from collections.abc import Callable

import numpy as np
from sensor_msgs.msg import PointCloud2, PointField
from tms_msg_ground.srv import GetHeights

from tms_config.site_file import Scanner
from tms_machine.places import Places
from tms_reason.errors import RosError
from tms_runtime.app import App
from tms_soil.patches import heights
from tms_soil.scanning import visible
from tms_soil.surface import Array, Heights

SERVICE = "/tms/ground/get_heights"
LIMIT = 5.0  # s for tms:ground to answer
CELL = 0.1  # m between points
AXES = ("x", "y", "z")
BYTES = 4  # of a number

Place = tuple[float, float]  # m, map


def start(app: App) -> None:
    """Let all scanners of the site scan."""
    carried = {one.machine for one in app.site.file.sim.scanners.values() if one.machine is not None}
    places = Places(app.ros, {name: app.site.border(name) for name in carried})
    app.ros.prepare(GetHeights, SERVICE)
    for number, (name, given) in enumerate(app.site.file.sim.scanners.items()):
        ScannerStandIn(app, name, given, _place_of(places, given), app.site.file.sim.seed + number)
    app.ready_when(lambda: None)


def _place_of(places: Places, given: Scanner) -> Callable[[], Place | None]:
    def place() -> Place | None:
        if given.machine is None:
            return given.x, given.y
        places.take()
        found = places.place(given.machine)
        return None if found is None else (found.x, found.y)

    return place


class ScannerStandIn:
    """One scanner."""

    def __init__(self, app: App, name: str, given: Scanner, place: Callable[[], Place | None], seed: int) -> None:
        self._ros, self._given, self._place = app.ros, given, place
        self._chance = np.random.default_rng(seed)
        self._publisher = app.ros.publisher(PointCloud2, f"/{name}/points", depth=1)
        app.ros.poll_in_thread(1.0 / given.hz, self.scan, name)

    def scan(self) -> None:
        """Publish what it sees now; nothing while nobody knows the ground, or where its machine stands."""
        place = self._place()
        if place is None or not self._ros.has_service(GetHeights, SERVICE):
            return
        (x, y), reach = place, self._given.range
        request = GetHeights.Request(x0=x - reach, y0=y - reach, x1=x + reach, y1=y + reach, cell=CELL)
        try:
            answer = self._ros.call(GetHeights, SERVICE, request, LIMIT)
        except RosError:
            return
        if answer.error_code:  # it stands beside the site
            return
        ground = heights(answer.ground)
        # A height that nobody has measured or made yet is an assumption of tms:ground, which a scan must not confirm.
        ground.z[np.isnan(answer.ages).reshape(ground.z.shape)] = np.nan
        message = cloud(scanned(ground, place, self._given, self._chance))
        message.header.stamp = answer.ground.header.stamp
        self._publisher.publish(message)


def scanned(ground: Heights, place: Place, given: Scanner, chance: np.random.Generator) -> Array:
    """The points [m of map] that a scanner at a place sees: N x 3."""
    base = np.nan_to_num(ground.at(np.array(place[0]), np.array(place[1])))
    seen = visible(ground, (*place, float(base) + given.height), given.range)
    x, y = ground.centres
    z = ground.z[seen] + given.noise * chance.standard_normal(int(np.count_nonzero(seen)))
    return np.column_stack((x[seen], y[seen], z))


def cloud(points: Array) -> PointCloud2:
    """Points of map as a message, without its time."""
    found = PointCloud2(
        height=1, width=len(points), point_step=len(AXES) * BYTES, row_step=len(points) * len(AXES) * BYTES,
        is_dense=True,
        fields=[PointField(name=axis, offset=k * BYTES, datatype=PointField.FLOAT32, count=1)
                for k, axis in enumerate(AXES)],
    )  # fmt: skip
    found.header.frame_id = "map"
    found.data.frombytes(points.astype("<f4").tobytes())
    return found
