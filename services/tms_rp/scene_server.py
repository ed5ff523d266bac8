"""Shows the scene of a planner: `/<machine>/rp/scene` for RViz while somebody listens, `rp/get_scene` for programs."""

from typing import Protocol

from tms_msg_rp.srv import GetScene
from visualization_msgs.msg import MarkerArray

from tms_config.models import MachineModel
from tms_reason.errors import TmsError
from tms_reason.texts import text
from tms_reason.wire import to_line
from tms_rp import scene_messages as messages
from tms_rp import scene_view as view
from tms_rp.clearance import Clearance
from tms_rp.kind import Angles
from tms_rp.scene import Scene
from tms_rp.trajectory import Trajectory
from tms_runtime.app import App

PERIOD = 0.5  # s between scenes


class Planner(Protocol):
    """The planner whose scene is shown (node.py)."""

    last: Trajectory | None

    def pose(self) -> Angles:
        """The present angles of all joints [rad]; raises SubtaskFailed."""

    def scene(self) -> Scene:
        """All that stands around the machine now; raises SubtaskFailed."""

    def areas(self) -> list[view.Area]:
        """Areas of records."""


class SceneServer:
    """Of one machine."""

    def __init__(self, app: App, model: MachineModel, planner: Planner) -> None:
        self._model, self._planner, self._clearance = model, planner, Clearance(model)
        self._frame = app.site.border(app.machine).base_frame
        self._markers = app.ros.publisher(MarkerArray, f"/{app.machine}/rp/scene", 1)
        app.ros.offer_slow(GetScene, f"/{app.machine}/rp/get_scene", self._answer)
        app.ros.poll_in_thread(PERIOD, self._publish, "scene")

    def _answer(self, _request: GetScene.Request, response: GetScene.Response) -> GetScene.Response:
        try:
            self._fill(response)
        except TmsError as error:
            response.error_code, response.error_msg = error.code, to_line(error.reason)
        return response

    def _publish(self) -> None:
        if not self._markers.get_subscription_count():
            return
        found = GetScene.Response()
        try:
            self._fill(found)
        except TmsError as error:
            return self._markers.publish(messages.refusal_marker(self._frame, text(error.reason, "en")))
        return self._markers.publish(messages.markers(self._frame, found.bodies, found.areas, found.way))

    def _fill(self, response: GetScene.Response) -> None:
        scene = self._planner.scene()
        shown = view.bodies(self._clearance, scene, self._planner.pose())
        response.bodies = [messages.body(one) for one in shown]
        response.areas = [messages.area(one) for one in self._planner.areas()]
        if (made := self._planner.last) is not None:
            response.way = messages.way(view.way_of_tip(self._model, made))
