"""Trackers of people, vehicles and gates, as `trackers:` of sensing.yaml names them. No protective devices."""

from collections.abc import Collection, Mapping
from typing import Literal

from pydantic import Field, model_validator

from tms_areas.reasons import GateNeedsArea, TopicOrRecord, TrackerOfNoArea, TrackersNeedAreas, TrackerTypeWrong
from tms_config.models import Settings
from tms_reason.reason import Reason
from tms_reason.validation import Wrong

Kind = Literal["person", "vehicle", "gate"]
OnSilence = Literal["stop", "hold", "warn"]

POINTS = ("geometry_msgs/msg/PoseArray", "geometry_msgs/msg/PoseStamped", "geometry_msgs/msg/PointStamped")
SWITCH = "std_msgs/msg/Bool"
# m around a told place that may be taken, by what the tracker is off and by the size of what it sees: our estimates.
RADIUS: dict[Kind, float] = {"person": 0.5, "vehicle": 3.0, "gate": 0.0}
# m/s that it goes on unseen: the walking speed of ISO 13855, and 20 km/h, a usual limit on sites.
SPEED: dict[Kind, float] = {"person": 1.6, "vehicle": 5.6, "gate": 0.0}


class Tracker(Settings):
    """One topic, or record, that tells who is where, in the frame `map`; an empty array says that nobody is seen.

    It must not tell the site's own machines. What has a time of measurement must not be older than `silent_after`.
    """

    kind: Kind
    topic: str = Field(default="", pattern=r"^(/?[A-Za-z][A-Za-z0-9_/]*)?$")
    type: str = POINTS[0]
    # Instead of a topic: fields `x` and `y` [m], numbers or arrays of one length; of a gate: `opened`, a bool.
    record: str = ""
    model: str = ""  # of the record; "" = one that all machines share
    reliability: Literal["reliable", "best_effort"] = "reliable"
    silent_after: float = Field(gt=0, le=60, default=1.0)  # s without a message after which it is silent
    # A silent tracker counts as a person inside (stop), holds machines until it is heard again, or is told only.
    on_silence: OnSilence = "stop"
    areas: tuple[str, ...] = ()  # ids of the unmanned areas that it watches; none: all
    radius: float | None = Field(gt=0, le=20, default=None)  # m, where RADIUS does not fit
    opened: bool = True  # what a gate or light barrier sends while somebody may pass

    @model_validator(mode="after")
    def _fits(self) -> "Tracker":
        if bool(self.topic) == bool(self.record):
            raise Wrong(TopicOrRecord(), "topic")
        types = (SWITCH,) if self.kind == "gate" else POINTS
        if self.topic and self.type not in types:
            raise Wrong(TrackerTypeWrong(self.kind, types), "type")
        if self.kind == "gate" and not self.areas:
            raise Wrong(GateNeedsArea(), "areas")
        return self

    def around(self, age: float) -> float:
        """How far from its place [m] somebody may be who was seen there `age` s ago."""
        radius = RADIUS[self.kind] if self.radius is None else self.radius
        return radius + SPEED[self.kind] * age


def trackers_flaw(trackers: Mapping[str, Tracker], unmanned: Collection[str]) -> Reason | None:
    """What is wrong with the trackers of a site that has these unmanned areas; None if nothing is."""
    if trackers and not unmanned:
        return TrackersNeedAreas(tuple(trackers))
    for name, one in trackers.items():
        for area in one.areas:
            if area not in unmanned:
                return TrackerOfNoArea(name, area, tuple(sorted(unmanned)))
    return None
