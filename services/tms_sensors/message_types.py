"""Classes of messages by the names that configuration has for them."""

import importlib

from tms_interfaces.generated import Message
from tms_reason.validation import Wrong
from tms_sensors.reasons import NoMessageType


def message_class(name: str) -> type[Message]:
    """The class of `package/msg/Name`.

    Raises:
        Wrong: it is not installed.
    """
    package, _, kind = name.split("/")
    try:
        found: type[Message] = getattr(importlib.import_module(f"{package}.msg"), kind)
        return found
    except (ImportError, AttributeError) as error:
        raise Wrong(NoMessageType(name)) from error
