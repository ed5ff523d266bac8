"""Areas in the gateway: its law where the site has areas, and the services by which a person enables a set of them.

No interface of ours is needed: a set is a parameter of the gateway, set and read by the types of ROS for parameters.
"""

import json
from typing import Any

from rcl_interfaces.msg import ParameterType, ParameterValue, SetParametersResult
from rcl_interfaces.srv import GetParameters, SetParametersAtomically

from tms_decision.gateway.state import Gateway
from tms_rc.area_path import area_path
from tms_rc.motion_servers import MotionServers
from tms_rc.stop_receipt import ReceiptTopic
from tms_reason.errors import TmsError
from tms_reason.wire import to_line
from tms_runtime.app import App


def begin(app: App, gateway: Gateway, servers: MotionServers, receipts: ReceiptTopic) -> None:
    """Watch the machine by its areas, where it has any; without them nothing is loaded, heard or served."""
    if not app.site.area_files and not area_path(app.site.state, app.machine).exists():
        return
    from tms_rc.acts import Acts
    from tms_rc.area_watch import AreaWatch

    servers.areas = watch = AreaWatch(app, gateway, servers.drives, Acts(app).tell)
    receipts.heard = watch.stops.put
    _Service(app, watch)


class _Service:
    def __init__(self, app: App, watch: Any) -> None:
        self._watch = watch
        app.ros.offer_slow(SetParametersAtomically, f"/{app.machine}/rc/areas/set", self._set)
        app.ros.offer_slow(SetParametersAtomically, f"/{app.machine}/rc/areas/escape", self._escape)
        app.ros.offer_slow(GetParameters, f"/{app.machine}/rc/areas/get", self._get)

    def _set(
        self, request: SetParametersAtomically.Request, response: SetParametersAtomically.Response
    ) -> SetParametersAtomically.Response:
        """Enable areas, or with `only_check` see whether that would be refused: area_request.py."""
        from tms_rc.area_request import area_request

        try:
            asked = area_request(request.parameters)
            self._watch.enable(asked.areas, asked.who, asked.only_check)
            response.result = SetParametersResult(successful=True)
        except TmsError as error:
            response.result = SetParametersResult(successful=False, reason=to_line(error.reason))
        return response

    def _escape(
        self, request: SetParametersAtomically.Request, response: SetParametersAtomically.Response
    ) -> SetParametersAtomically.Response:
        """Let the machine back in, for `who`."""
        from tms_rc.area_request import escape_request

        try:
            self._watch.escape(escape_request(request.parameters))
            response.result = SetParametersResult(successful=True)
        except TmsError as error:
            response.result = SetParametersResult(successful=False, reason=to_line(error.reason))
        return response

    def _get(self, request: GetParameters.Request, response: GetParameters.Response) -> GetParameters.Response:
        """Some of `id`, `who`, `areas` of the enabled set; unset where none is."""
        from tms_areas.geojson import written

        one = self._watch.enabled
        known = {} if one is None else {"id": one.areas.id, "who": one.who, "areas": json.dumps(written(one.areas))}
        response.values = [_value(known.get(name)) for name in request.names]
        return response


def _value(text: str | None) -> ParameterValue:
    if text is None:
        return ParameterValue(type=ParameterType.PARAMETER_NOT_SET)
    return ParameterValue(type=ParameterType.PARAMETER_STRING, string_value=text)
