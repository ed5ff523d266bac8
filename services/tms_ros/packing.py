"""Messages as bytes."""

from rclpy.serialization import deserialize_message, serialize_message

from tms_ros.goals import InterfaceType, Message


def pack(message: Message) -> bytes:
    """A message as it would be on the wire."""
    return bytes(serialize_message(message))


def unpack(data: bytes, message_type: InterfaceType) -> Message:
    """The message that was packed.

    Raises:
        RuntimeError: it is of another type or damaged.
    """
    return deserialize_message(data, message_type)
