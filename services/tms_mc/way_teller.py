"""Tells the way that a machine drives, for who watches, as Nav2's planner does."""

from nav_msgs.msg import Path

from tms_config.clock import monotonic
from tms_control.path import Path as Way
from tms_machine.border import PLAN
from tms_mc.goal_poses import in_map_along
from tms_runtime.app import App

AGAIN = 1.0  # s after which it is told again, for who has come meanwhile
STEP = 0.5  # m between poses


class WayTeller:
    """Of one machine. For one thread."""

    def __init__(self, app: App) -> None:
        self._plans = app.ros.publisher(Path, f"/{app.machine}/{PLAN}", 1)
        self._told: Way | None = None
        self._due = 0.0

    def tell(self, way: Way | None) -> None:
        """Tell a new way at once, and the same one every second; None: it stands, and searches."""
        now = monotonic()
        if way is None or (way is self._told and now < self._due):
            return
        self._told, self._due = way, now + AGAIN
        self._plans.publish(in_map_along(way, STEP))
