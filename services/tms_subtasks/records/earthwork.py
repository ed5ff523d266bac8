"""What excavators and trucks that work together know: where to dig, for whom, and how much of the job is done."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeVar

from pydantic import Field, ValidationError, model_validator

from tms_kit.subtask import Params, SubtaskFailed
from tms_machine.reasons import BadRecord, ListsDiffer
from tms_reason.validation import Wrong, explain
from tms_soil.dig_point import DigPoint
from tms_soil.surface import Bounds, Point

SHARED = ""  # machine of a record that all share
NOTHING = 0.04  # m3 in a bucket, as it lay: half of the least that a dig is to bring
DIG, DUMP = "dig_point", "dump_point"  # records of the excavator that excavate_simple and release_simple read
Read = Callable[[str, str], Mapping[str, Any]]
P = TypeVar("P", bound=Params)


class Earthwork(Params):
    """Where an excavator may dig, and which trucks it loads; read anew at each bucket, as sensing may change it."""

    area_x: list[float] = Field(min_length=3)  # m, map: corners of the area in which it digs
    area_y: list[float] = Field(min_length=3)  # m, map
    floor: float  # m, map: it digs no deeper, whatever the site's design says
    near: float = Field(gt=0)  # m from its place: no edge comes nearer ...
    far: float = Field(gt=0)  # m, ... nor goes further out
    deepest: float = Field(gt=0)  # m below its tracks that its arm can dig
    trucks: list[str]  # machines that it loads
    job: str  # shared record that counts

    @model_validator(mode="after")
    def _corners(self) -> "Earthwork":
        if len(self.area_x) != len(self.area_y):
            raise Wrong(ListsDiffer(f"area_x {len(self.area_x)}, area_y {len(self.area_y)}"))
        return self

    @property
    def area(self) -> list[Point]:
        """Corners [m, map]."""
        return list(zip(self.area_x, self.area_y, strict=True))

    @property
    def bounds(self) -> Bounds:
        """The rectangle around the area."""
        return min(self.area_x), min(self.area_y), max(self.area_x), max(self.area_y)


class Job(Params):
    """How much earth is to be moved, and how much has been; volumes are those of soil as it lay."""

    volume: float = Field(gt=0)  # m3
    moved: float = Field(ge=0)  # m3, into trucks
    counted: int = Field(ge=0)  # buckets: each has a number, and counts once
    done: bool


class Bucket(Params):
    """The bucket that a dump point was chosen for."""

    x: float  # m, base_link of the excavator: where it opens
    y: float  # m
    number: int = Field(ge=0)  # 1 for the first one of the job; 0: none was chosen yet
    truck: str
    bank: float = Field(ge=0)  # m3 in the bucket before it was emptied
    before: float = Field(ge=0)  # m3 in the truck before that, as it lay

    @property
    def bearing(self) -> float:
        """Direction in which it opens [rad, base_link]."""
        return math.atan2(self.y, self.x)


class Fruitless(NamedTuple):
    """A dig that has brought nothing."""

    number: int  # of its bucket
    x: float  # m, base_link of the excavator
    y: float  # m
    depth: float  # m

    @property
    def point(self) -> DigPoint:
        """As one that is compared with others."""
        return DigPoint(self.x, self.y, 0.0, self.depth, 0.0, 0.0, 0.0)


class Dug(Params):
    """The dig that was chosen last."""

    number: int = Field(ge=0)  # of its bucket
    x: float = 0.0  # m, base_link of the excavator
    y: float = 0.0  # m
    depth: float = 0.0  # m
    # number, x, y and depth of each dig before it that has brought nothing
    fruitless: list[float] = Field(default_factory=list)


@dataclass(frozen=True)
class Counted:
    """A job after a look at the last bucket."""

    moved: float  # m3, as it lay
    buckets: int
    done: bool

    def fields(self) -> dict[str, Any]:
        """Of the job's record; written at once, so that none is counted without its volume."""
        return {"moved": self.moved, "counted": self.buckets, "done": self.done}


def counted(job: Job, bucket: Bucket, truck: float, left: bool) -> Counted:
    """Count the last bucket, unless it is counted already.

    What the truck has gained counts, and no more than the bucket held: after a loss the same look gives the same again.

    Args:
        job: as its record tells it.
        bucket: the last one.
        truck: what its truck carries now [m3, as it lay].
        left: whether there is something left to dig.
    """
    moved, buckets = job.moved, job.counted
    if bucket.number == job.counted + 1:
        moved += min(max(0.0, truck - bucket.before), bucket.bank)
        buckets = bucket.number
    return Counted(moved, buckets, not left or moved >= job.volume)


def earthwork_of(read: Read, machine: str, record: str) -> Earthwork:
    """The record as it is now; `read` as get_param_from_db. Raises SubtaskFailed: BadRecord, or as `read`."""
    return _as(Earthwork, read, machine, record)


def job_of(read: Read, name: str) -> Job:
    """The job as it is now. Raises as `earthwork_of`."""
    return _as(Job, read, SHARED, name)


def bucket_of(read: Read, machine: str) -> Bucket:
    """The bucket for which a dump point was chosen last. Raises as `earthwork_of`."""
    return _as(Bucket, read, machine, DUMP)


def fruitless(read: Read, machine: str) -> list[Fruitless]:
    """The last digs, as far back as none has brought anything. Raises as `earthwork_of`.

    Where an arm comes less deep than the ground promises, the ground is as before, and would promise the same again.
    """
    dig, bucket = _as(Dug, read, machine, DIG), bucket_of(read, machine)
    if bucket.number == 0 or bucket.bank >= NOTHING:
        return []
    told = dig.fruitless
    found = [Fruitless(int(told[k]), *told[k + 1 : k + 4]) for k in range(0, len(told) - 3, 4)]
    if not found or found[-1].number not in (bucket.number, bucket.number - 1):
        found = []  # something was brought since
    if dig.number == bucket.number:
        found.append(Fruitless(dig.number, dig.x, dig.y, dig.depth))
    return found


def _as(kind: type[P], read: Read, machine: str, record: str) -> P:
    fields = read(machine, record)
    try:
        return kind.model_validate(fields)
    except ValidationError as error:
        raise SubtaskFailed(BadRecord(f"{machine}/{record}".removeprefix("/"), explain(error))) from None
