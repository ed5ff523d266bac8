"""What is known of a run."""

from dataclasses import dataclass, field

from builtin_interfaces.msg import Time
from tms_msg_ts.msg import PlaceOrder, SharedValue

from tms_machine.values import Value
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
    writes: list[SharedValue] = field(default_factory=list)  # shared values that it writes
    orders: list[PlaceOrder] = field(default_factory=list)  # of places that its machines hold and take
    values: dict[str, Value] = field(default_factory=dict)  # more fields of the run, which are shown with it
    state: str = "preparing"
    reason: Reason | None = None
