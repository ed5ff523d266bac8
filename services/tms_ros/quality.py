"""Qualities of service, with the reasons for them."""

from rclpy import qos
from rclpy.duration import Duration
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

# With the default depth 10, twenty goals at once lose requests for ever.
SERVICE = QoSProfile(depth=100, durability=qos.qos_profile_services_default.durability)


def lease(seconds: float) -> QoSProfile:
    """Latched; DDS notifies readers when a writer has not asserted itself for `seconds`."""
    return QoSProfile(
        depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL, liveliness=qos.LivelinessPolicy.MANUAL_BY_TOPIC,
        liveliness_lease_duration=Duration(seconds=seconds),
    )  # fmt: skip


def topic(depth: int, latched: bool, best_effort: bool = False, lives: float = 0.0) -> QoSProfile:
    """`latched`: readers that come later get the last messages, those of the last `lives` [s]; 0: however old."""
    durability = DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE
    reliability = ReliabilityPolicy.BEST_EFFORT if best_effort else ReliabilityPolicy.RELIABLE
    age = Duration(seconds=lives)
    return QoSProfile(depth=depth, durability=durability, reliability=reliability, lifespan=age)


def misfit(writer: QoSProfile, reader: QoSProfile) -> str:
    """Why DDS does not connect two endpoints of a topic, in rclpy's words; empty when it does."""
    found, reason = qos.qos_check_compatible(writer, reader)
    return str(reason).removeprefix("ERROR: ").rstrip("; ") if found == qos.QoSCompatibility.ERROR else ""
