"""Tells what nodes of active runs have written for each other."""

import json

from rcl_interfaces.msg import ParameterType, ParameterValue
from rcl_interfaces.srv import GetParameters

from tms_runtime.app import App
from tms_ts.active_runs import ActiveRuns


class Blackboards:
    """Serves the values that a node of an active run sees."""

    def __init__(self, runs: ActiveRuns) -> None:
        self._runs = runs

    def serve(self, app: App, name: str) -> None:
        """Offer the service."""
        app.ros.offer(GetParameters, name, self.get)

    def get(self, request: GetParameters.Request, response: GetParameters.Response) -> GetParameters.Response:
        """The names are a run and the path of a node; one value: its entries as a JSON object, unset without any."""
        run_id, path = (*request.names, "", "")[:2]
        run = self._runs.find(run_id)
        board = None if run is None else run.boards.get(path)
        if board is None:
            response.values = [ParameterValue(type=ParameterType.PARAMETER_NOT_SET)]
        else:
            text = json.dumps(dict(board.items()), ensure_ascii=False, default=str)
            response.values = [ParameterValue(type=ParameterType.PARAMETER_STRING, string_value=text)]
        return response
