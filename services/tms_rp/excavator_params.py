"""`tms_rp_excavator_param_get` and `_set`: what our planner knows of its machine, and how it is set."""

import math
from collections.abc import Callable

from geometry_msgs.msg import Point, Pose, Quaternion
from tms_msg_rp.srv import TmsRpExcavatorParamGet, TmsRpExcavatorParamSet

from tms_config.models import Joint
from tms_machine.geometry import Quaternion as Turn
from tms_reason.errors import SubtaskFailed
from tms_reason.wire import to_line
from tms_rp.excavator_settings import Settings
from tms_rp.kind import Angles
from tms_runtime.app import App


class ExcavatorParams:
    """Serves both for one excavator.

    `joints`: of the arm, in the order of the angles [rad] that `now` gives; it raises SubtaskFailed. `tool`: position
    [m] and orientation of bucket_end_link in base_link at such angles.
    """

    def __init__(
        self, app: App, joints: dict[str, Joint], now: Callable[[], Angles],
        tool: Callable[[Angles], tuple[tuple[float, float, float], Turn]],
    ) -> None:  # fmt: skip
        self._app, self._joints, self._now, self._tool = app, joints, now, tool
        self.settings = Settings()
        app.ros.offer(TmsRpExcavatorParamGet, f"/{app.machine}/tms_rp_excavator_param_get", self.get)
        app.ros.offer(TmsRpExcavatorParamSet, f"/{app.machine}/tms_rp_excavator_param_set", self.set)

    def get(
        self, request: TmsRpExcavatorParamGet.Request, response: TmsRpExcavatorParamGet.Response
    ) -> TmsRpExcavatorParamGet.Response:
        """What is asked for."""
        response.success = True
        if request.get_joint_limits:
            joints = self._joints.values()
            response.joint_names = list(self._joints)
            response.min_positions = [-math.inf if one.min is None else one.min for one in joints]
            response.max_positions = [math.inf if one.max is None else one.max for one in joints]
            response.max_velocities = [one.velocity for one in joints]
            response.max_accelerations = [one.acceleration for one in joints]
        if request.get_configuration:
            self.settings.fill(response)
        if request.get_current_state:
            try:
                self._state(response)
            except SubtaskFailed as error:
                response.success, response.message = False, to_line(error.reason)
        return response

    def _state(self, response: TmsRpExcavatorParamGet.Response) -> None:
        now = self._now()
        response.joint_states.header.stamp = self._app.ros.now()
        response.joint_states.name, response.joint_states.position = list(self._joints), now
        (x, y, z), (qx, qy, qz, qw) = self._tool(now)
        turn = Quaternion(x=qx, y=qy, z=qz, w=qw)
        response.current_ee_pose = Pose(position=Point(x=x, y=y, z=z), orientation=turn)

    def set(
        self, request: TmsRpExcavatorParamSet.Request, response: TmsRpExcavatorParamSet.Response
    ) -> TmsRpExcavatorParamSet.Response:
        """Take all values, or none: what our planner cannot honour is refused. Stored plans are never planned anew."""
        try:
            self.settings = self.settings.changed(request)
            response.success = True
        except SubtaskFailed as error:
            response.message = to_line(error.reason)
        self.settings.fill(response)
        return response
