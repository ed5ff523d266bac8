"""The check of names and short texts from outside, before they go into ROS, file names or the database.

A ROS string ends at its first NUL: the rest is lost without an error, and the receiver cannot see that. So the sender
checks first.
"""

import re
import unicodedata
from collections.abc import Iterable, Iterator
from typing import Annotated, Any

from pydantic import AfterValidator, Field

from tms_reason import texts
from tms_reason.errors import TmsError
from tms_reason.reason import Reason
from tms_reason.reasons import BadName, BadText, ControlLetter, EmptyName, HiddenLetter, LongName, OuterBlank
from tms_reason.validation import Wrong

MAX_LENGTH = 200  # letters
EXCERPT = 40  # letters of a text in a reason
CUT = re.compile("[\0\ud800-\udfff]")
CONTROL = ("Cc", "Cs", "Zl", "Zp")  # Unicode categories: control characters, halves of characters, breaks


def control_letter(text: str) -> ControlLetter | None:
    """The first control character in a readable form; None if there is none."""
    found = next((letter for letter in text if unicodedata.category(letter) in CONTROL), None)
    return None if found is None else ControlLetter(f"U+{ord(found):04X}")


def name_flaw(name: str) -> Reason | None:
    """What is wrong with a name, None if nothing is."""
    if not name.strip():
        return EmptyName()
    if not name.isprintable():
        return control_letter(name) or HiddenLetter()
    if name != name.strip():
        return OuterBlank()
    return LongName(MAX_LENGTH) if len(name) > MAX_LENGTH else None


def control(text: str) -> str | None:
    """As `control_letter`, in English."""
    found = control_letter(text)
    return None if found is None else f"the control character {found.letter}"


def flaw(name: str) -> str | None:
    """As `name_flaw`, in English."""
    found = name_flaw(name)
    return None if found is None else texts.text(found, "en")


def check_text(field: str, text: str) -> None:
    """Refuse a line for people that holds a control character.

    Raises:
        TmsError: BAD_TEXT.
    """
    if (found := control_letter(text)) is not None:
        raise TmsError(BadText(field, repr(text[:EXCERPT]), found))


def check_sent(service: str, message: Any) -> None:
    """Refuse a ROS message that would not arrive whole: a text is cut at a NUL, and half a character has no bytes.

    Raises:
        TmsError: BAD_TEXT.
    """
    for field, text in _texts(message):
        if (found := CUT.search(text)) is not None and (letter := control_letter(found[0])) is not None:
            raise TmsError(BadText(f"{service}: {field}", repr(text[:EXCERPT]), letter))


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
    if (why := name_flaw(name)) is not None:
        raise Wrong(BadName(repr(name[:EXCERPT]), why))
    return name


def _plain_text(text: str) -> str:
    if (found := control_letter(text)) is not None:
        raise Wrong(found)
    return text


_SHOWN = {"pattern": r"^[^\u0000-\u001f\u007f-\u009f\u2028\u2029]*$"}  # the same rule for the API's description
Name = Annotated[str, AfterValidator(_plain_name), Field(min_length=1, max_length=MAX_LENGTH, json_schema_extra=_SHOWN)]
Text = Annotated[str, AfterValidator(_plain_text), Field(json_schema_extra=_SHOWN)]
