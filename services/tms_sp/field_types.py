"""Finds the type at the end of a path of sensing.yaml from the message's field types, before any message arrives."""

import re
from collections.abc import Callable, Collection

from tms_reason.reason import Reason
from tms_reason.validation import Wrong
from tms_sp.reasons import NoArray, NoFieldInside, NoMessageField, NoNames, WrongKind, WrongKindOf

NUMBERS = {"float", "double", *(f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64))}
PLAIN = {"boolean", "string", "wstring", *NUMBERS}  # an octet is bytes in Python, which a record cannot hold
VALUES = {*PLAIN, *(f"{kind}[]" for kind in PLAIN)}
NAMES = {"string[]", "wstring[]"}
STAMPS = {"builtin_interfaces/Time", *NUMBERS}
PART = re.compile(r"(\w+)(?:\[([^\]]+)\])?")  # a field, maybe with the number or name of an element
ARRAY = re.compile(r"sequence<(.+?)(?:, \d+)?>|(.+)\[\d+\]")
BOUND = re.compile(r"<\d+>")  # bound of a text's length

Fields = dict[str, str]  # name -> type, as in the message class
FieldsOf = Callable[[str], Fields]  # for a message inside another one, `package/Name`


class FieldTypes:
    """The types of a message's fields, and of the messages inside it."""

    def __init__(self, fields: Fields, fields_of: FieldsOf) -> None:
        self._fields, self._fields_of = fields, fields_of

    def check(self, path: str, allowed: Collection[str], wanted: Reason) -> None:
        """Refuse a path that does not end at one of the `allowed` types.

        Raises:
            Wrong: names the path, its type, and the fields inside it.
        """
        kind = self._at(path)
        if kind in allowed:
            return
        inside = self._inside(kind.removesuffix("[]"))
        stem = f"{path}[0]" if kind.endswith("[]") else path
        hints = tuple(f"{stem}.{name}" for name in inside)
        raise Wrong(WrongKindOf(path, kind, wanted, hints) if hints else WrongKind(path, kind, wanted))

    def _at(self, path: str) -> str:
        """The type at the end of a path; `kind[]` for an array of any length."""
        fields, kind = self._fields, ""
        for name, index in (found.groups() for found in PART.finditer(path)):
            fields = self._inside(kind) if kind else fields
            if name not in fields:
                raise Wrong(NoMessageField(path, tuple(fields)) if fields else NoFieldInside(path, name, kind))
            kind = _plain(fields[name])
            if index is not None:
                if not kind.endswith("[]"):
                    raise Wrong(NoArray(path, name, kind))
                if not index.isdecimal() and _plain(fields.get("name", "")) not in NAMES:
                    raise Wrong(NoNames(path, name))
                kind = kind.removesuffix("[]")
        return kind

    def _inside(self, kind: str) -> Fields:
        return self._fields_of(kind) if "/" in kind and not kind.endswith("[]") else {}


def _plain(kind: str) -> str:
    kind = BOUND.sub("", kind)
    array = ARRAY.fullmatch(kind)
    return f"{array[1] or array[2]}[]" if array else kind
