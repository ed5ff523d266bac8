"""The ways that machines are about to drive, as their navigation tells them on `/<machine>/plan`."""

import math
from collections.abc import Iterable, Iterator

from nav_msgs.msg import Path

from tms_machine.border import PLAN
from tms_machine.places import IN_MAP
from tms_ros.node import Ros

Flat = tuple[float, float]
AS_GOOD = 0.1  # m that a way may be drawn off
MOST_POSES = 20_000  # of a message: 2 km at 0.1 m; a longer one is not looked at
MOST = 100  # places of a way that is drawn; an even choice of more


class PlannedPaths:
    """Of some machines. For one thread."""

    def __init__(self, ros: Ros, machines: Iterable[str]) -> None:
        self._plans = {name: ros.sample(Path, f"/{name}/{PLAN}") for name in machines}

    def take(self) -> Iterator[tuple[str, list[Flat]]]:
        """What has come since the last call: machines, and places of their ways [m, map]."""
        for name, taken in self._plans.items():
            for plan in taken():
                yield name, drawn(plan)


def drawn(path: Path) -> list[Flat]:
    """The places that show a way; nothing of one in another frame, or with a place that is no number."""
    import shapely  # for a console that nobody moves anything with, it is only memory

    places = [(pose.pose.position.x, pose.pose.position.y) for pose in path.poses[:MOST_POSES]]
    fine = len(path.poses) <= MOST_POSES and all(math.isfinite(value) for place in places for value in place)
    if path.header.frame_id not in IN_MAP or not fine or len(places) < 2:
        return []
    kept = shapely.get_coordinates(shapely.LineString(places).simplify(AS_GOOD, preserve_topology=False)).tolist()
    step = math.ceil((len(kept) - 1) / (MOST - 1)) or 1
    return [(round(x, 2), round(y, 2)) for x, y in (*kept[:-1:step], kept[-1])]
