"""What is wrong with a configuration, and with what is measured against it."""

from tms_reason.quantities import Radians
from tms_reason.reason import Reason


# fmt: off
class BelowLimit(Reason, text="{angle} is below its limit {limit}"): angle: Radians; limit: Radians
class AboveLimit(Reason, text="{angle} is above its limit {limit}"): angle: Radians; limit: Radians
