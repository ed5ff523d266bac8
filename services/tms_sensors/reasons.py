"""Why something that configuration names cannot be heard."""

from tms_reason.reason import Reason
from tms_reason.remedies import EDIT_CONFIG, Remedy

BUILD = Remedy("edit_config", "", "Correct the type, or build its package")


# fmt: off
class NoMessageType(Reason, text="there is no message type {name}", action=BUILD): name: str
class NoFieldOf(Reason, text="{type} has no field {field}", action=EDIT_CONFIG): type: str; field: str
# fmt: on
