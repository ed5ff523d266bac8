"""A receipt of a stop as a reason."""

from tms_msg_rc.msg import StopReceipt

from tms_decision.reasons import Stood, StoodWithoutJoints
from tms_reason.reason import Reason


def stood_after(receipt: StopReceipt, cause: Reason) -> Reason:
    """How long it took until the machine stood, and how far it went."""
    seconds, way = receipt.seconds, receipt.travel_m
    if not receipt.travel_joint:
        return StoodWithoutJoints(seconds, way, cause)
    return Stood(seconds, receipt.travel_rad, receipt.travel_joint, way, cause)
