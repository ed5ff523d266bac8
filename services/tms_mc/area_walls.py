"""The areas that the gateway of this machine keeps, as bodies that its own searches for ways keep clear of."""

from rcl_interfaces.srv import GetParameters

from tms_control.ground import Body, Outline
from tms_control.path import Pose
from tms_control.way_check import array
from tms_mc.reasons import AreaBorder
from tms_runtime.app import App

LIMIT = 0.8  # s for the gateway to answer
KEPT_OFF = 0.7  # m that a way keeps off a border in addition: else the gateway would stop the machine there


class AreaWalls:
    """Of a site that has areas; of another one nothing is asked or loaded."""

    def __init__(self, app: App) -> None:
        self._app, self._id, self._bodies = app, "", list[Body]()
        self._outline = Outline.of(app.site.model_of(app.machine))

    def read(self, here: Pose) -> list[Body]:
        """The walls now, but for those in which the machine stands: its gateway says whether it may leave them.

        Raises:
            RosError: the gateway does not answer.
        """
        if not self._app.site.area_files:
            return []
        request = GetParameters.Request(names=["id", "areas"])
        service = f"/{self._app.machine}/rc/areas/get"
        found, areas = self._app.ros.call(GetParameters, service, request, LIMIT).values
        if found.string_value != self._id:
            self._bodies, self._id = _walls(areas.string_value), found.string_value
        return [one for one in self._bodies if one.gaps(self._outline, array(here))[0] > 0]


def _walls(document: str) -> list[Body]:
    from tms_areas.geojson import gathered, read
    from tms_areas.walls import walls

    if not document:
        return []
    areas = gathered([read(document, "areas", None)])
    return [Body(AreaBorder(), corners, KEPT_OFF) for corners in walls(areas)]
