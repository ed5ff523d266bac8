"""What a leaf gives a subtask besides its record: inputs of the goal, behind the record's name as in a web address.

LeafNodeBase is the definition of the C++ system's version 5 and has no field for them. A subtask of that system finds
no record of such a name and refuses the goal; if it did not see the inputs, it would move the machine in another way.
"""

import re
from collections.abc import Mapping
from urllib.parse import parse_qsl, quote, urlencode

Inputs = Mapping[str, str | bool]
KINDS: dict[str, type] = {"previous_target_record_name": str, "read_direction": str, "blade_hold": bool}  # name -> type
_BEHIND = re.compile(rf"(.*)\?((?:{'|'.join(KINDS)})=[^?]*)", re.DOTALL)


def joined(record: str, inputs: Inputs) -> str:
    """A record's name with the inputs of a goal; `{key}` and `$key$` in a value stay readable."""
    if not inputs:
        return record
    texts = {name: "true" if value is True else str(value) for name, value in inputs.items()}
    return f"{record}?{urlencode(texts, safe='{},/$', quote_via=quote)}"


def parted(text: str) -> tuple[str, dict[str, str | bool]]:
    """The record's name, and the inputs behind it."""
    found = _BEHIND.fullmatch(text)
    if found is None:
        return text, {}
    pairs = parse_qsl(found[2], keep_blank_values=True)
    return found[1], {name: value == "true" if KINDS.get(name) is bool else value for name, value in pairs}
