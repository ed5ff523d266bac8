"""Values of records: Python on one side, rcl_interfaces/Parameter on the wire, types kept.

A document, or an array of documents, has no type among parameters: it travels as the bytes of its JSON text.
"""

import json
from collections.abc import Iterable, Mapping
from typing import Any

from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue

Document = dict[str, Any]
Value = bool | int | float | str | list[bool] | list[int] | list[float] | list[str] | Document | list[Document]

# Python type -> (number of the type, field) for a value alone and for an array of it
ALONE: dict[type, tuple[int, str]] = {
    bool: (ParameterType.PARAMETER_BOOL, "bool_value"),
    int: (ParameterType.PARAMETER_INTEGER, "integer_value"),
    float: (ParameterType.PARAMETER_DOUBLE, "double_value"),
    str: (ParameterType.PARAMETER_STRING, "string_value"),
}
ARRAY: dict[type, tuple[int, str]] = {
    bool: (ParameterType.PARAMETER_BOOL_ARRAY, "bool_array_value"),
    int: (ParameterType.PARAMETER_INTEGER_ARRAY, "integer_array_value"),
    float: (ParameterType.PARAMETER_DOUBLE_ARRAY, "double_array_value"),
    str: (ParameterType.PARAMETER_STRING_ARRAY, "string_array_value"),
}
FIELD_ALONE = dict(ALONE.values())
FIELD_ARRAY = dict(ARRAY.values())


def can_travel(value: Any) -> bool:
    """Whether a value has a type that parameters know, or is a document that JSON knows: no bytes, no dates."""
    plain = _kind_of_all(value) if isinstance(value, list) else _kind(value)
    documents = value if isinstance(value, list) else [value]
    return plain is not None or all(isinstance(one, dict) and _nested(one) for one in documents)


def to_parameters(fields: Mapping[str, Any]) -> list[Parameter]:
    """Fields as parameters; integers and doubles mixed in one array become doubles.

    Raises:
        TypeError: a value that `can_travel` refuses.
    """
    return [Parameter(name=name, value=_to_value(name, value)) for name, value in fields.items()]


def from_parameters(parameters: Iterable[Parameter]) -> dict[str, Value]:
    """Parameters as Python values; unset ones, and bytes that are no document, are left out."""
    return {parameter.name: value for parameter in parameters if (value := from_value(parameter.value)) is not None}


def from_value(value: ParameterValue) -> Value | None:
    """One value; None when it is not set, or is bytes that are no document."""
    if value.type == ParameterType.PARAMETER_BYTE_ARRAY:
        return _document(b"".join(value.byte_array_value))
    if value.type in FIELD_ALONE:
        alone: Value = getattr(value, FIELD_ALONE[value.type])
        return alone
    return list(getattr(value, FIELD_ARRAY[value.type])) if value.type in FIELD_ARRAY else None


def _to_value(name: str, value: Any) -> ParameterValue:
    kind = _kind_of_all(value) if isinstance(value, list) else _kind(value)
    if kind is None and can_travel(value):
        return ParameterValue(type=ParameterType.PARAMETER_BYTE_ARRAY, byte_array_value=_json(value))
    if kind is None:
        raise TypeError(f"{name}: a {type(value).__name__} cannot travel as a parameter")
    number, field = (ARRAY if isinstance(value, list) else ALONE)[kind]
    plain = [kind(part) for part in value] if isinstance(value, list) else kind(value)
    message = ParameterValue(type=number)
    setattr(message, field, plain)
    return message


def _kind(value: Any) -> type | None:
    """Base type of a value; bool before int, since True is an int, and the store's own integers are ints."""
    if isinstance(value, int) and not -(2**63) <= value < 2**63:
        return None  # parameters have 64 bits
    return next((kind for kind in ALONE if isinstance(value, kind)), None)


def _kind_of_all(values: list[Any]) -> type | None:
    """The type of all values of an array; integers among doubles count as doubles, and so does an empty array."""
    kinds = {_kind(value) for value in values} or {float}
    if kinds == {int, float}:
        return float
    return kinds.pop() if len(kinds) == 1 else None


def _nested(value: Any) -> bool:
    """Whether JSON can hold a value as it is."""
    if isinstance(value, dict):
        return all(isinstance(name, str) and _nested(part) for name, part in value.items())
    return all(map(_nested, value)) if isinstance(value, list) else _kind(value) is not None


def _json(value: Any) -> list[bytes]:
    return [bytes([byte]) for byte in json.dumps(value, separators=(",", ":")).encode()]


def _document(data: bytes) -> Value | None:
    try:
        found = json.loads(data)
    except ValueError:
        return None
    return found if isinstance(found, (dict, list)) else None
