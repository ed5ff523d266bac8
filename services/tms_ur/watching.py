"""The API's side of areas, people and hardware: what gateways and trackers tell."""

import json
from typing import TYPE_CHECKING, Any

from diagnostic_msgs.msg import DiagnosticArray
from rcl_interfaces.srv import GetParameters

from tms_config.clock import monotonic
from tms_config.config import Site
from tms_machine.sensing import load_sensing
from tms_reason.errors import RosError
from tms_ros.node import Ros
from tms_ur.board import Board
from tms_ur.reason_view import of_line
from tms_ur.watch_models import EnabledAreas, SeenBy, Spot, Watched

if TYPE_CHECKING:  # its libraries are loaded only where a site has trackers
    from tms_areas.intruders import Told

PERIOD = 0.2  # s between looks at the trackers
LIMIT = 2.0  # s for a gateway to tell its areas


class Watching:
    """Keeps the board up to date with it; without trackers and hardware in the configuration, nothing is heard."""

    def __init__(self, ros: Ros, site: Site, board: Board) -> None:
        self._ros, self._site, self._board = ros, site, board
        trackers = load_sensing(site).trackers if site.area_files else {}
        for name, use in site.file.machines.items():
            if use.hardware or trackers:
                ros.subscribe(DiagnosticArray, f"/{name}/rc/watches", self._taker(name), latched=True)
        if trackers:
            from tms_sensors.trackers import Hearing

            self._hearing = Hearing(ros, trackers)
            ros.poll_in_thread(PERIOD, self._look, "trackers")

    def _taker(self, machine: str) -> Any:
        def take(message: DiagnosticArray) -> None:
            told = {one.name: one for one in message.status}
            people, hardware = told.get("people"), told.get("hardware")
            said = {} if hardware is None else {one.key: one.value for one in hardware.values}
            self._board.put_watched(machine, Watched(people=of_line(people.message) if people else None, hardware=said))

        return take

    def _look(self) -> None:
        told, now = self._hearing.take().told, monotonic()
        self._board.put_seen([seen_by(name, one, now) for name, one in told.items()])

    def areas(self) -> EnabledAreas:
        """The enabled areas, from the first gateway that knows any."""
        for machine in self._site.file.machines if self._site.area_files else ():
            try:
                request = GetParameters.Request(names=["id", "who", "areas"])
                answer = self._ros.call(GetParameters, f"/{machine}/rc/areas/get", request, LIMIT)
            except RosError:
                continue
            found, who, areas = (one.string_value for one in answer.values)
            if found:
                return EnabledAreas(id=found, by=who, areas=json.loads(areas))
        return EnabledAreas(id=None)


def seen_by(tracker: str, told: "Told", now: float) -> SeenBy:
    """A tracker at a time [s, monotonic]."""
    silent = not told.heard or told.wrong is not None or now - told.since > told.given.silent_after
    places = [Spot(x=round(x, 2), y=round(y, 2)) for x, y in told.places.tolist()]
    return SeenBy(tracker=tracker, kind=told.given.kind, silent=silent, opened=told.opened, places=places)
