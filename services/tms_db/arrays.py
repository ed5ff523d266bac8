"""Changes of an array in a record: what the C++ system does with $addToSet, $push, $pull and an empty array."""

from collections.abc import Callable

from tms_db.reasons import NoArrayChange
from tms_db.records import Scalar, Value, bad

Array = list[Scalar]
CHANGES: dict[str, Callable[[Array, Scalar], Array]] = {
    "add": lambda array, value: array if value in array else [*array, value],
    "push": lambda array, value: [*array, value],
    "remove": lambda array, value: [one for one in array if one != value],
    "reset": lambda array, value: [],
}


def changed(change: str, value: Value) -> Callable[[Array], Array]:
    """The function that makes the new array of the old one.

    Raises:
        DbError: BAD_RECORD; there is no such change, or the value is an array.
    """
    if change not in CHANGES or not isinstance(value, Scalar):
        raise bad(NoArrayChange(change))
    return lambda array: CHANGES[change](array, value)
