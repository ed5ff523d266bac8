"""An entry of the journal as a line of a file: one letter for its kind, then the message in base64."""

import base64

from tms_msg_db.msg import Event, Run

from tms_ros.packing import unpack

KINDS: dict[bytes, type[Run] | type[Event]] = {b"V": Run, b"E": Event}
LETTERS = {kind: letter for letter, kind in KINDS.items()}
EARLIER = b"R"  # a run of earlier releases, without its last field `values`: the message ends before their number
NO_VALUES = bytes(4)  # how many values there are, as CDR has it


def to_line(kind: type[Run] | type[Event], packed: bytes) -> bytes:
    """The line, without a line break."""
    return LETTERS[kind] + base64.b64encode(packed)


def of_line(line: bytes) -> Run | Event:
    """The entry of a line, also of a line that an earlier release has written.

    Raises:
        ValueError, RuntimeError: it is damaged.
    """
    kind, data = line[:1], base64.b64decode(line[1:], validate=True)
    if kind == EARLIER:
        return unpack(data + NO_VALUES, Run)
    if kind not in KINDS:
        raise ValueError(f"no kind of entry is {kind!r}")
    return unpack(data, KINDS[kind])
