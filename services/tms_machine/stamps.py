"""Times and durations of ROS messages, in seconds."""

from builtin_interfaces.msg import Duration, Time


def seconds(at: Time | Duration) -> float:
    """A time [s since its clock began] or a duration [s]."""
    return float(at.sec + at.nanosec * 1e-9)


def time(at: float) -> Time:
    """A time as a message."""
    return Time(sec=int(at), nanosec=int(at % 1 * 1e9))


def duration(length: float) -> Duration:
    """A duration as a message."""
    return Duration(sec=int(length), nanosec=int(length % 1 * 1e9))
