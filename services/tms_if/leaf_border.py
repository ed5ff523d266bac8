"""Process `<machine>:if`: leaf goals of peers that speak LeafNodeBase as version 6 of the C++ system does.

It runs with their form of the type in place of ours (tms_runtime/wire_form.py) and serves the machine's subtasks under
the names that peers know; within this system the same subtasks have other names and another type
(tms_machine/leaf_forms.py). Subtasks that peers serve are served to our scheduler under such names in turn. It maps
goals only: permits, gateway and stops are those of every goal.
"""

import re
from functools import partial
from typing import Any

from tms_msg_if.action import LeafGoal
from tms_msg_ts.action import LeafNodeBase  # in the form of the peers

from tms_if import motion_border
from tms_if.relay import Relay
from tms_machine.goal_inputs import joined, parted
from tms_machine.leaf_forms import misfit, own_action
from tms_machine.permit import Permit
from tms_machine.reasons import InputsNotTaken
from tms_reason.reason import Reason
from tms_ros.client import AnyPeer
from tms_ros.goals import Ended, Outcome
from tms_ros.server import AnyGoal
from tms_runtime.app import App

SEND_GOAL = "tms_msg_ts/action/LeafNodeBase_SendGoal"
LOOK_PERIOD = 1.0  # s between looks for servers of peers
THEIRS: Any = LeafNodeBase  # mypy knows the fields of version 5 only


def start(app: App) -> None:
    """Serve our subtasks to peers, and those of peers to our scheduler as they appear."""
    border = LeafBorder(app)
    for subtask in app.site.model_of(app.machine).subtasks:
        border.serve_ours(subtask)
    if app.site.file.peers[app.machine].motions:
        motion_border.serve(app)
    app.ros.poll_in_thread(LOOK_PERIOD, border.look, "peers")
    app.ready_when(lambda: None)
    app.log.info("serving", form=app.process.form)


class LeafBorder:
    """The actions of one machine, in both directions."""

    def __init__(self, app: App) -> None:
        self._app, self._ros, self._machine = app, app.ros, app.machine
        self._ours = frozenset(app.site.model_of(app.machine).subtasks)
        self._theirs: set[str] = set()  # subtasks of peers that are served here
        self._named = re.compile(rf"/{app.machine}/(\w+)/_action/send_goal")

    def serve_ours(self, subtask: str) -> None:
        """Serve one of our subtasks to peers."""
        kind, name = own_action(self._app.site, self._machine, subtask)
        relay = ToOurs(self._app, subtask, self._ros.peer(kind, name))
        self._ros.serve(THEIRS, f"/{self._machine}/{subtask}", relay.run, relay.accept)

    def look(self) -> None:
        """Serve to our scheduler what a peer has begun to serve; it stays served, and refuses goals when it is gone."""
        for name, types in self._ros.node.get_service_names_and_types():
            found = self._named.fullmatch(name)
            subtask = found[1] if found and SEND_GOAL in types else ""
            if subtask and subtask not in self._ours | self._theirs and self._has_server(name):
                self._theirs.add(subtask)
                self._serve_theirs(subtask)

    def _has_server(self, name: str) -> bool:
        return bool(self._ros.node.get_subscriptions_info_by_topic(f"rq{name}Request", no_mangle=True))

    def _serve_theirs(self, subtask: str) -> None:
        peer = self._ros.peer(THEIRS, f"/{self._machine}/{subtask}")
        relay = ToTheirs(self._app, subtask, peer)
        self._ros.serve(LeafGoal, own_action(self._app.site, self._machine, subtask)[1], relay.run, relay.accept)
        self._app.log.info("peer_found", subtask=subtask, reason=relay.misfit())


class LeafRelay(Relay):
    """Leaf goals between two types: of feedback and result, both have the same fields."""

    def feedback(self, feedback: Any) -> Any:
        return self._served.Feedback(status=feedback.status)

    def result(self, outcome: Outcome, result: Any) -> Any:
        return self._served.Result(result=outcome is Outcome.SUCCEEDED)


class ToOurs(LeafRelay):
    """Goals of a peer for one of our subtasks, which its permit tells that the client of the goal can be heard."""

    def __init__(self, app: App, subtask: str, peer: AnyPeer) -> None:
        super().__init__(app.machine, THEIRS, peer)
        self._misfit = partial(misfit, app.ros, app.site, app.machine, subtask, servers=False)
        self._permit = Permit(app.ros, app.pulse, app.machine, f"if_{subtask}")

    def accept(self, request: Any) -> Reason | None:
        return super().accept(request) or self._misfit()

    def run(self, goal: AnyGoal) -> Ended[Any]:
        self._permit.hold(goal.uuid)
        try:
            return super().run(goal)
        finally:
            self._permit.drop()

    def request(self, request: Any) -> LeafGoal.Goal:
        return to_ours(request)


class ToTheirs(LeafRelay):
    """Goals of our scheduler for a subtask of a peer."""

    def __init__(self, app: App, subtask: str, peer: AnyPeer) -> None:
        super().__init__(app.machine, LeafGoal, peer)
        self.misfit = partial(misfit, app.ros, app.site, app.machine, subtask, servers=True)

    def accept(self, request: LeafGoal.Goal) -> Reason | None:
        lost = tuple(name for name in parted(request.record_name)[1] if name not in fields())
        return super().accept(request) or (InputsNotTaken(lost) if lost else self.misfit())

    def request(self, request: LeafGoal.Goal) -> Any:
        return to_theirs(request)


def fields() -> set[str]:
    """Names of the fields of a goal in the form of the peers."""
    return set(THEIRS.Goal.get_fields_and_field_types())


def to_ours(theirs: Any) -> LeafGoal.Goal:
    """A goal of a peer with its inputs behind the record's name; empty texts and false are as if not given."""
    given = {name: getattr(theirs, name) for name in sorted(fields() - {"model_name", "record_name"})}
    record = joined(theirs.record_name, {name: value for name, value in given.items() if value})
    return LeafGoal.Goal(model_name=theirs.model_name, record_name=record)


def to_theirs(ours: LeafGoal.Goal) -> Any:
    """A goal of ours with its inputs in the fields that the peers have for them."""
    record, inputs = parted(ours.record_name)
    return THEIRS.Goal(model_name=ours.model_name, record_name=record, **inputs)
