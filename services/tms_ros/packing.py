"""Messages as bytes, and back."""

from rclpy.serialization import deserialize_message, serialize_message

from tms_interfaces.generated import M, Message


def pack(message: Message) -> bytes:
    """A message, serialised as for the wire."""
    return bytes(serialize_message(message))


def unpack(data: bytes, message_type: type[M]) -> M:
    """The message that was packed.

    Raises:
        RuntimeError: it is of another type or damaged.
    """
    message: M = deserialize_message(data, message_type)
    return message
