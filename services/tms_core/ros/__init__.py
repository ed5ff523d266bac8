"""The one wrapper over rclpy."""

from tms_core.ros.client import Call, Peer
from tms_core.ros.goals import LOST_TEXT, Ended, Outcome, Rejection
from tms_core.ros.node import Ros
from tms_core.ros.packing import pack, unpack
from tms_core.ros.server import Goal

__all__ = ["LOST_TEXT", "Call", "Ended", "Goal", "Outcome", "Peer", "Rejection", "Ros", "pack", "unpack"]
