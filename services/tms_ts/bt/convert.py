"""Text to value and value to value, by the rules of the C library (BehaviorTree.CPP v3)."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable
from typing import Any, Final, NewType

from tms_ts.bt.status import Status

UInt = NewType("UInt", int)  # the library's unsigned int: a port type of its own


class Missing:
    """The answer when nothing can be read; a value of its own, as None may be a value."""

    __slots__ = ()

    def __repr__(self) -> str:
        return "MISSING"

    def __bool__(self) -> bool:
        return False


MISSING: Final = Missing()

CPP_NAMES: Final[dict[Any, str]] = {
    str: "std::string",
    int: "int",
    float: "double",
    bool: "bool",
    UInt: "unsigned int",
    Status: "BT::NodeStatus",
    list[int]: "std::vector<int>",
    list[float]: "std::vector<double>",
    Any: "void",
}
TRUE_WORDS: Final = frozenset({"1", "true", "TRUE", "True"})
FALSE_WORDS: Final = frozenset({"0", "false", "FALSE", "False"})
_INTEGER = re.compile(r"[ \t\n\v\f\r]*([+-]?[0-9]+)")
_REAL = re.compile(
    r"[ \t\n\v\f\r]*([+-]?)(?:(0[xX](?=\.?[0-9a-fA-F])[0-9a-fA-F]*\.?[0-9a-fA-F]*(?:[pP][+-]?[0-9]+)?)"
    r"|((?=\.?[0-9])[0-9]*\.?[0-9]*(?:[eE][+-]?[0-9]+)?)|(inf(?:inity)?|nan))",
    re.IGNORECASE,
)
_LONGEST_NUMBER = 400  # digits; Python's own limit for int() is far above, C's result is "out of range"


def text_to_integer(text: str, low: int, high: int) -> int | Missing:
    """A decimal integer between `low` and `high`; MISSING for anything else."""
    found = _INTEGER.match(text)
    if found is None or len(found[1]) > _LONGEST_NUMBER:
        return MISSING
    number = int(found[1])
    return number if low <= number <= high else MISSING


def text_to_int(text: str) -> int | Missing:
    """Read an int as C++ does."""
    return text_to_integer(text, -(2**31), 2**31 - 1)


def text_to_unsigned(text: str) -> int | Missing:
    """Read an unsigned int as C++ does: a negative number wraps around."""
    number = text_to_integer(text, -(2**64) + 1, 2**64 - 1)
    return number if isinstance(number, Missing) else number & 0xFFFFFFFF  # -1 wraps, as in C


def text_to_double(text: str) -> float | Missing:
    """Read a double as C++ does in the locale C."""
    found = _REAL.match(text)
    if found is None:
        return MISSING
    sign, hexadecimal, decimal, word = found.groups()
    if word:
        return float(sign + word)
    try:
        number = float.fromhex(hexadecimal) if hexadecimal else float(decimal)
    except OverflowError:
        return MISSING
    if number == float("inf"):
        return MISSING
    digits = (hexadecimal[2:] if hexadecimal else decimal).lower().split("p" if hexadecimal else "e")[0]
    if number < sys.float_info.min and digits.strip("0."):
        return MISSING  # underflow is "out of range" as well
    return -number if sign == "-" else number


def text_to_bool(text: str) -> bool | Missing:
    """Read a bool as the library does: true, false, 1, 0 and their capital forms."""
    if text in TRUE_WORDS:
        return True
    return False if text in FALSE_WORDS else MISSING


def text_to_status(text: str) -> Status | Missing:
    """The name of a status."""
    return Status.__members__.get(text, MISSING)


def _split(one: Callable[[str], Any]) -> Callable[[str], list[Any]]:
    return lambda text: [0 if one(part) is MISSING else one(part) for part in text.split(";")]


FROM_TEXT: Final[dict[Any, Callable[[str], Any]]] = {
    str: lambda text: text,
    Any: lambda text: text,
    int: text_to_int,
    UInt: text_to_unsigned,
    float: text_to_double,
    bool: text_to_bool,
    Status: text_to_status,
    list[int]: _split(text_to_int),
    list[float]: _split(text_to_double),
}


def to_text(value: object) -> str | Missing:
    """The text that the library makes of a value; MISSING where it makes none."""
    if isinstance(value, str):
        return value
    if isinstance(value, Status):
        return MISSING
    if isinstance(value, bool):
        return "1" if value else "0"
    if isinstance(value, int):
        return str(value)
    return f"{value:.6f}" if isinstance(value, float) else MISSING


def _number(value: float, want: Any) -> int | float | bool | Missing:
    if want is bool:
        return value != 0
    if want is float:
        return float(value)
    low, high = (0, 2**32 - 1) if want is UInt else (-(2**31), 2**31 - 1)
    if not low <= value <= high:  # NaN as well
        return MISSING
    return int(value) if int(value) == value else MISSING


def convert(value: Any, want: Any) -> Any:
    """The stored value as a port of type `want` reads it, or MISSING."""
    if want is Any:
        return value
    if want is str:
        return to_text(value)
    if isinstance(value, str):
        return FROM_TEXT[want](value)
    if want is Status or isinstance(value, Status):
        return value if want is Status and isinstance(value, Status) else MISSING
    if isinstance(value, int | float) and want in (int, UInt, float, bool):
        return _number(value, want)
    return value if isinstance(value, list) and want in (list[int], list[float]) else MISSING


def kind_of(value: object) -> Any:
    """The port type that a value has by itself."""
    for kind in (Status, bool, int, float, str):
        if isinstance(value, kind):
            return kind
    return Any
