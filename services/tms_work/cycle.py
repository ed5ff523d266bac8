"""One cycle of a machine: what it moved, how long each part took. The model of a document of the database, too."""

from typing import Annotated, Literal

from pydantic import AwareDatetime, BaseModel, ConfigDict, Field, model_validator

from tms_reason.validation import Wrong
from tms_work.reasons import EndsBeforeBegin, NoSuchPart, PartsTooLong

Kind = Literal["dig", "haul"]  # an excavator's bucket, a carrier's way to where it tips and back
PARTS: dict[Kind, tuple[str, ...]] = {
    "dig": ("dig", "swing_loaded", "dump", "swing_back", "wait_for_truck", "stopped"),
    "haul": ("load", "haul", "tip", "return", "wait", "stopped"),
}
SLACK = 0.5  # s by which parts, which are measured each for itself, may be longer than the whole

Name = Annotated[str, Field(min_length=1, max_length=200)]
Amount = Annotated[float, Field(ge=0)]


class Cycle(BaseModel):
    """One cycle; run, machine and number identify it."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    run_id: Name
    machine: Name
    number: int = Field(ge=1)  # counts in a run and machine
    kind: Kind
    begun_at: AwareDatetime
    ended_at: AwareDatetime
    parts: dict[str, Amount]  # s, by the names of PARTS; a part that did not happen is absent
    soil: str = ""
    bank: Amount = 0.0  # m3, as the soil lay
    loose: Amount = 0.0  # m3, as it was carried
    mass: Amount = 0.0  # kg
    fill: Amount | None = None  # loose by heaped capacity of the bucket or vessel
    distance: Amount = 0.0  # m, driven
    buckets: int = Field(ge=0, default=0)  # that a carrier's load came in
    into: str = ""  # machine that took the soil; empty: the ground
    unseen: Amount = 0.0  # s of it in which nobody looked: what was moved then is estimated, or missing
    measured: bool = False  # by the machine itself; otherwise it is an estimate

    @property
    def seconds(self) -> float:
        """How long it took [s]."""
        return (self.ended_at - self.begun_at).total_seconds()

    @model_validator(mode="after")
    def _times_fit(self) -> "Cycle":
        if self.seconds < 0:
            raise Wrong(EndsBeforeBegin(), "ended_at")
        for name in self.parts:
            if name not in PARTS[self.kind]:
                raise Wrong(NoSuchPart(PARTS[self.kind]), "parts", name)
        whole = sum(self.parts.values()) + self.unseen
        if whole > self.seconds + SLACK:
            raise Wrong(PartsTooLong(whole, self.seconds), "parts")
        return self
