"""Reads and replaces stamps inside messages; in the bytes, where their place is known."""

import struct
from typing import Any

from tms_cli.reasons import StampFixed
from tms_machine.sensing import Input
from tms_reason.errors import TmsError
from tms_ros.packing import pack, unpack
from tms_sp.mapping import Getter, field_getter, stamp_path

SECOND = 1_000_000_000  # ns
BODY = 4  # bytes of the CDR head; the second one is the byte order
TIME = 8  # bytes


class Stamps:
    """Stamps in the messages of one topic."""

    def __init__(self, given: Input, message_class: Any) -> None:
        """Find the stamp that the input reads.

        Raises:
            Wrong: the message has no such field.
        """
        fields = message_class.get_fields_and_field_types()
        self.path = stamp_path(given, fields)
        self._class = message_class
        self._value: Getter | None = field_getter(self.path, fields) if self.path else None
        self._leads = self.path == "header.stamp" and next(iter(fields)) == "header"

    def check(self, data: bytes) -> Any:
        """Decode a message, since a subscriber would end at invalid bytes.

        Raises:
            RuntimeError: these are not the bytes of such a message.
        """
        return unpack(data, self._class)

    def read(self, message: Any) -> int | None:
        """The stamp [ns]; None where the message has none."""
        if self._value is None:
            return None
        found = self._value(message)
        return int(found * SECOND) if isinstance(found, (int, float)) else found.sec * SECOND + found.nanosec

    def replaced(self, data: bytes, message: Any, stamp: int) -> bytes:
        """The message with another stamp (ns).

        Raises:
            TmsError: BAD_STAMP; a number in an array is no stamp that can be replaced.
        """
        if self._leads:  # the usual case: the message need not be packed again
            order = "<" if data[1] & 1 else ">"
            return data[:BODY] + struct.pack(f"{order}iI", *divmod(stamp, SECOND)) + data[BODY + TIME :]
        assert self._value is not None and self.path is not None
        found = self._value(message)
        if hasattr(found, "sec"):
            found.sec, found.nanosec = divmod(stamp, SECOND)
        else:
            *parents, name = self.path.split(".")
            if "[" in name:
                raise TmsError(StampFixed(self.path), "BAD_STAMP")
            owner = message
            for part in parents:
                owner = getattr(owner, part)
            setattr(owner, name, type(found)(stamp / SECOND))
        return pack(message)
