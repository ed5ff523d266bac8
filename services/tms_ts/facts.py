"""What is known of a run."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from builtin_interfaces.msg import Time

from tms_machine.values import Value
from tms_places.waits import Order
from tms_reason.reason import Reason


@dataclass
class Facts:
    """What is reported of a run; changed by its own thread only."""

    run_id: str
    number: int  # fencing number
    task_id: int
    description: str
    machines: list[str]
    started: Time
    records: list[str] = field(default_factory=list)  # records that the tree names
    writes: set[tuple[str, str]] = field(default_factory=set)  # shared records and fields that it writes
    orders: Mapping[str, set[Order]] = field(default_factory=dict)  # of places that its machines hold and take
    values: dict[str, Value] = field(default_factory=dict)  # more fields of the run, which are shown with it
    state: str = "preparing"
    reason: Reason | None = None
