"""The one check of names and short texts that come from outside and go into ROS, file names or the database.

A ROS string ends at its first NUL: the rest is lost without an error, and the receiver cannot see that. So whoever
sends checks first.
"""

import re
import unicodedata
from collections.abc import Iterable, Iterator
from typing import Annotated, Any

from pydantic import AfterValidator, Field

from tms_reason.errors import TmsError

LONGEST = 200  # letters
CUT = re.compile("[\0\ud800-\udfff]")
CONTROL = ("Cc", "Cs", "Zl", "Zp")  # Unicode categories: control characters, halves of characters, breaks


def control(text: str) -> str | None:
    """The first control character, as people write it; None if there is none."""
    found = next((letter for letter in text if unicodedata.category(letter) in CONTROL), None)
    return None if found is None else f"the control character U+{ord(found):04X}"


def flaw(name: str) -> str | None:
    """What is wrong with a name, None if nothing is."""
    if not name.strip():
        return "is empty"
    if not name.isprintable():
        return f"holds {control(name) or 'a character that nobody sees'}"
    if name != name.strip():
        return "begins or ends with a blank"
    return f"has more than {LONGEST} letters" if len(name) > LONGEST else None


def check_text(what: str, text: str) -> None:
    """Refuse a line for people that holds a control character.

    Raises:
        TmsError: BAD_TEXT.
    """
    if (found := control(text)) is not None:
        raise TmsError(f"{what} holds {found}: remove it", "BAD_TEXT")


def check_sent(what: str, message: Any) -> None:
    """Refuse a ROS message of ours that would not arrive whole: a text is cut at a NUL, half a character has no bytes.

    Raises:
        TmsError: BAD_TEXT.
    """
    for field, text in _texts(message):
        if (found := CUT.search(text)) is not None:
            raise TmsError(f"{what}: {field} {text[:40]!r} holds {control(found[0])}: remove it", "BAD_TEXT")


def _texts(message: Any) -> Iterator[tuple[str, str]]:
    """All texts of a message, each with the name of its field."""
    for field in message.get_fields_and_field_types():
        value = getattr(message, field)
        several: Iterable[Any] = value if isinstance(value, list) else (value,)
        for one in several:
            if isinstance(one, str):
                yield field, one
            elif hasattr(one, "get_fields_and_field_types"):
                yield from _texts(one)


def _plain_name(name: str) -> str:
    if (why := flaw(name)) is not None:
        raise ValueError(f"{name[:40]!r} {why}: write a plain name")
    return name


def _plain_text(text: str) -> str:
    if (found := control(text)) is not None:
        raise ValueError(f"holds {found}: remove it")
    return text


_SHOWN = {"pattern": r"^[^\u0000-\u001f\u007f-\u009f\u2028\u2029]*$"}  # to readers of the API's description
Name = Annotated[str, AfterValidator(_plain_name), Field(min_length=1, max_length=LONGEST, json_schema_extra=_SHOWN)]
Text = Annotated[str, AfterValidator(_plain_text), Field(json_schema_extra=_SHOWN)]
