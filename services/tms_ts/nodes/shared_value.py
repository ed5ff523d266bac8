"""The values that the Mongo nodes make of a text: by its form, by a given type, or from a key of the blackboard."""

from __future__ import annotations

import re

from tms_reason.reason import Reason
from tms_ts.bt.convert import MISSING, Missing, convert, text_to_double, text_to_int, text_to_integer, to_text
from tms_ts.bt.node import Node
from tms_ts.tree_reasons import BeginningWritten, KeyHasNoValue, NoSuchType, PortType, WholeWritten
from tms_ts.world import Value

ANY_INTEGER = 10**400
TRUTH = {"true": True, "false": False}
TYPES = {"int": int, "double": float, "bool": bool, "string": str}  # words of input_type
_KEY = re.compile(r"\\(.+)\\", re.DOTALL)
_TEXT = re.compile(r'"(.*)"', re.DOTALL)
_ALL_NUMBER = re.compile(r"\s*[+-]?(?:[0-9]+|(?=.*\.)[0-9]*\.[0-9]*(?:[eE][+-]?[0-9]+)?)", re.ASCII)


def typed(text: str) -> Value:
    """The value that a text stands for: true, false, a number by its beginning ("3_FLG" is 3), "quoted", or itself.

    An integer of more than 32 bits is a double, as in version 6 of the C++ system.
    """
    if (quoted := _TEXT.fullmatch(text)) is not None:
        return quoted[1]
    if text in TRUTH:
        return TRUTH[text]
    real = "." in text
    if not real and text_to_integer(text, -ANY_INTEGER, ANY_INTEGER) is MISSING:
        return text
    number: float | Missing = MISSING if real else text_to_int(text)
    if isinstance(number, Missing):
        number = text_to_double(text)
    return text if isinstance(number, Missing) else number


def forced(value: Value, type_: str) -> Value | Missing:
    """A text, or a value of the blackboard, as a given type; MISSING if it is none, or if there is no such type."""
    kind = TYPES.get(type_)
    if kind is bool:
        return value if isinstance(value, bool) else TRUTH.get(str(value), MISSING)
    if kind is str:
        if isinstance(value, bool):
            return "true" if value else "false"
        quoted = _TEXT.fullmatch(value) if isinstance(value, str) else None
        return to_text(value) if quoted is None else quoted[1]
    found: Value | Missing = MISSING if kind is None else convert(value, kind)
    return found


def referred(node: Node, text: str, form: re.Pattern[str] = _KEY) -> Value | Missing | None:
    r"""The value of the key that a text of the form \key\ names, MISSING if it has none; None for another text."""
    named = form.fullmatch(text)
    if named is None:
        return None
    value = node.blackboard.get(named[1])
    if isinstance(value, Value):
        return value
    node.reason = KeyHasNoValue(named[1])
    return MISSING


def keys_named(*texts: str | None, form: re.Pattern[str] = _KEY) -> list[str]:
    r"""The keys that texts of the form \key\ name."""
    return [named[1] for text in texts if text is not None and (named := form.fullmatch(text)) is not None]


def written(node: Node, text: str, type_: str) -> Value | Missing:
    """The value that a node writes for its `input_value`; MISSING fails the node, whose reason is set."""
    if type_ and type_ not in TYPES:
        node.reason = NoSuchType(type_)
        return MISSING
    value = referred(node, text)
    if isinstance(value, Missing):
        return MISSING
    if isinstance(value, str) and not type_:
        return TRUTH.get(value, value)  # no number is made of a text of the blackboard: 3725960300000 is a name
    if not type_:
        return typed(text) if value is None else value
    found = forced(text if value is None else value, type_)
    if isinstance(found, Missing):
        node.reason = PortType("input_value", text, node.registration_name, type_)
    return found


def hopeless(node: Node, text: str, type_: str) -> Reason | None:
    """Why a literal `input_value` cannot be written."""
    if type_ and type_ not in TYPES:
        return NoSuchType(type_)
    known = type_ and _KEY.fullmatch(text) is None
    if known and isinstance(forced(text, type_), Missing):
        return PortType("input_value", text, node.registration_name, type_)
    return None


def surprising(text: str) -> Reason | None:
    """What the author of a literal without a type should know of the value that is written."""
    value = typed(text)
    if isinstance(value, bool | str):
        return None
    if _ALL_NUMBER.fullmatch(text) is None:
        return BeginningWritten(text, str(value))
    whole = text_to_int(text)
    differs = not isinstance(whole, Missing) and whole != value
    return WholeWritten(text, str(whole)) if differs else None
