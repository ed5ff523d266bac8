"""Reasons why a cycle of work is none."""

from tms_reason.quantities import Seconds
from tms_reason.reason import Reason


# fmt: off
class EndsBeforeBegin(Reason, text="is before begun_at: did a clock go back?"): pass
class NoSuchPart(Reason, text="is none of {parts}"): parts: tuple[str, ...]
class PartsTooLong(Reason, text="take {parts} together, the cycle took {cycle}"): parts: Seconds; cycle: Seconds
# fmt: on
