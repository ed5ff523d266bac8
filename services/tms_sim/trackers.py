"""Process `sim:trackers`: trackers that see people and vehicles walk along their paths, gates and light barriers."""

import itertools
import json
import math
from collections.abc import Mapping
from typing import Any

from geometry_msgs.msg import Point, PointStamped, Pose, PoseArray, PoseStamped
from pydantic import ValidationError
from std_msgs.msg import Bool, Header, String

from tms_areas.reasons import NoTracker
from tms_areas.trackers import Tracker
from tms_config.clock import monotonic
from tms_config.site_file import TrackerStandIn, Walk
from tms_config.yaml_file import located
from tms_machine.frames import MAP
from tms_machine.sensing import load_sensing
from tms_reason.errors import ConfigError
from tms_reason.validation import explain
from tms_runtime.app import App

PERIOD = 0.1  # s between messages

Place = tuple[float, float]  # m, map


def start(app: App) -> None:
    """Let the trackers tell what they see; /sim/trackers takes {tracker: what its stand-in is told} as JSON.

    Raises:
        ConfigError: sensing.yaml does not have one of them.
    """
    known = {name: one for name, one in load_sensing(app.site).trackers.items() if one.topic}
    given = app.site.file.sim.trackers
    for name in given:
        if name not in known:
            raise ConfigError(located(app.site.path, NoTracker(name, tuple(known)), "sim", "trackers", name))
    eyes = {name: _Eye(app, known[name], one) for name, one in given.items()}
    app.ros.subscribe(String, "/sim/trackers", lambda message: _change(app, eyes, message.data), depth=10)
    app.ros.every(PERIOD, lambda: _tell(eyes))
    app.ready_when(lambda: None)


class _Eye:
    """One tracker."""

    def __init__(self, app: App, given: Tracker, told: TrackerStandIn) -> None:
        self._app, self._given = app, given
        self._publisher = app.ros.publisher(_type(given), given.topic)
        self.be(told)

    def be(self, told: TrackerStandIn) -> None:
        self._told, self._since = told, monotonic()

    def tell(self) -> None:
        if self._told.silent:
            return
        passed = (monotonic() - self._since) * self._app.site.file.sim.speed
        header = Header(frame_id=MAP, stamp=self._app.ros.now())
        for message in messages(self._given, self._told, passed, header):
            self._publisher.publish(message)


def _tell(eyes: Mapping[str, _Eye]) -> None:
    for eye in eyes.values():
        eye.tell()


def _change(app: App, eyes: Mapping[str, _Eye], text: str) -> None:
    try:
        found = {name: TrackerStandIn.model_validate(one) for name, one in json.loads(text).items()}
    except (ValueError, AttributeError) as error:
        why = explain(error) if isinstance(error, ValidationError) else str(error)
        app.log.error("bad_trackers", text=text, reason=why)
        return
    for name, one in found.items():
        if name in eyes:
            eyes[name].be(one)


def _type(given: Tracker) -> Any:
    if given.kind == "gate":
        return Bool
    return {one.__name__: one for one in (PoseArray, PoseStamped, PointStamped)}[given.type.rpartition("/")[2]]


def messages(given: Tracker, told: TrackerStandIn, passed: float, header: Header) -> list[Any]:
    """What a tracker says after some time [s]; one that tells a single place says nothing where there is nobody."""
    if given.kind == "gate":
        return [Bool(data=told.open == given.opened)]
    points = [Point(x=x, y=y) for x, y in (place_on(walk, passed) for walk in told.walks)]
    if _type(given) is PoseArray:
        return [PoseArray(header=header, poses=[Pose(position=one) for one in points])]
    if _type(given) is PoseStamped:
        return [PoseStamped(header=header, pose=Pose(position=one)) for one in points[:1]]
    return [PointStamped(header=header, point=one) for one in points[:1]]


def place_on(walk: Walk, passed: float) -> Place:
    """Where somebody is after some time [s]."""
    legs = list(itertools.pairwise(walk.path))
    whole = sum(math.dist(old, new) for old, new in legs)
    if not whole:
        return walk.path[0]
    gone = walk.speed * max(0.0, passed - walk.after) % (2 * whole)
    gone = min(gone, 2 * whole - gone)
    for old, new in legs:
        length = math.dist(old, new)
        if gone <= length and length:
            share = gone / length
            return old[0] + share * (new[0] - old[0]), old[1] + share * (new[1] - old[1])
        gone -= length
    return walk.path[-1]
