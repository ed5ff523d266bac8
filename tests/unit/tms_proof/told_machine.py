"""A machine of plain figures, and what it tells."""

from collections.abc import Mapping

from tms_proof.channel import Place
from tms_proof.facts import JointFacts, MachineFacts, ResponseFacts, SourceFacts, StillFacts
from tms_proof.source import SourceSample
from tms_proof.standstill import JOINTS, StandStill

STILL = StillFacts(velocity=0.01, linear=0.02, angular=0.01, seconds=0.2)
END_STOPS, NO_STOPS = JointFacts(1.0, -3.0, 3.0), JointFacts(1.0)
BOOM, ARM = ResponseFacts(0.6, 0.5, 1.0), ResponseFacts(0.4, 0.8, 2.0)
PERIOD = 0.05  # s


def machine(
    joints: Mapping[str, JointFacts] = {"boom": END_STOPS, "arm": END_STOPS},
    responses: Mapping[str, ResponseFacts] = {"boom": BOOM},
    sources: tuple[str, ...] = (JOINTS,), jitter: float = 0.0, speed: float = 1.0, at_once: bool = False,
) -> StandStill:  # fmt: skip
    found = {name: SourceFacts(PERIOD, "utc", 2.0, f"/zx200/{name}", jitter) for name in sources}
    return StandStill(MachineFacts(
        "zx200", joints, responses, STILL, found, drive_velocity=2.0, turn_velocity=1.0, stops_at_once=at_once,
        speed=speed,
    ))  # fmt: skip


def tell(watch: StandStill, source: str, at: float, places: Mapping[str, Place], number: int = 0) -> None:
    watch.take(source, SourceSample(at, at, number, places, {}))


def joints(watch: StandStill, at: float, **angles: float) -> None:
    """Joint states; those that are not named are at 0."""
    tell(watch, JOINTS, at, {name: (angles.get(name, 0.0),) for name in watch.sources[JOINTS].channels})
