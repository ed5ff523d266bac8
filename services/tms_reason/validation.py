"""Turns pydantic's findings about data into reasons, each with its key."""

from collections.abc import Iterator, Mapping
from typing import Any

from pydantic import ValidationError

from tms_reason import reasons
from tms_reason.reason import Foreign, Reason
from tms_reason.reasons import BadSetting, BadValueOf, KeyProblem, MissingKey, MoreProblems, UnknownKey
from tms_reason.texts import sentence

Keys = tuple[int | str, ...]
PLAIN: dict[str, type[UnknownKey | MissingKey]] = {"extra_forbidden": UnknownKey, "missing": MissingKey}
KINDS: dict[str, type[Reason]] = {  # of pydantic's findings without an argument
    "float_type": reasons.MustBeNumber, "float_parsing": reasons.MustBeNumber, "finite_number": reasons.MustBeFinite,
    "int_type": reasons.MustBeWhole, "int_parsing": reasons.MustBeWhole, "int_from_float": reasons.MustBeWhole,
    "bool_type": reasons.MustBeTrueOrFalse, "bool_parsing": reasons.MustBeTrueOrFalse,
    "string_type": reasons.MustBeText, "list_type": reasons.MustBeList, "tuple_type": reasons.MustBeList,
    "dict_type": reasons.MustBeKeys, "model_type": reasons.MustBeKeys,
}  # fmt: skip
BOUNDS: dict[str, tuple[type[Reason], str]] = {  # and of those with one, which has this name
    "greater_than": (reasons.MustBeAbove, "gt"), "greater_than_equal": (reasons.MustBeAtLeast, "ge"),
    "less_than": (reasons.MustBeBelow, "lt"), "less_than_equal": (reasons.MustBeAtMost, "le"),
    "literal_error": (reasons.MustBeOneOf, "expected"), "enum": (reasons.MustBeOneOf, "expected"),
    "string_pattern_mismatch": (reasons.MustFitPattern, "pattern"),
}  # fmt: skip
SECRET = ("uri", "password")  # parts of keys whose values are never shown


class Wrong(ValueError):
    """The error of our validators: a reason, and its key below the validated value."""

    def __init__(self, reason: Reason, *key: int | str) -> None:
        super().__init__(sentence(reason, "en"))
        self.reason, self.key = reason, key


def problems(error: ValidationError) -> Iterator[tuple[Keys, Reason]]:
    """Key and reason of each finding of a validation, in the order of the data."""
    for one in error.errors(include_url=False):
        own = one.get("ctx", {}).get("error")
        keys = one["loc"]
        if isinstance(own, Wrong):
            yield (*keys, *own.key), own.reason
        elif one["type"] in PLAIN:
            yield keys, PLAIN[one["type"]]()
        elif isinstance(own, ValueError):
            yield keys, BadSetting(Foreign(str(own)))
        else:
            yield keys, _refused(keys, _reason(one["type"], one.get("ctx", {}), one["msg"]), one["input"])


def explain(error: ValidationError) -> Reason:
    """The first problem of a validation with its key, and the number of further ones."""
    keys, reason = next(problems(error))
    more = error.error_count() - 1
    found = KeyProblem(dotted(keys), reason) if keys else reason
    return MoreProblems(found, more) if more else found


def dotted(keys: Keys) -> str:
    """A key as people write it: `machines.zx200.model`."""
    return ".".join(str(part) for part in keys)


def _reason(kind: str, context: Mapping[str, Any], words: str) -> Reason:
    """A finding of pydantic as a reason; in its own words where they are rare."""
    if kind in KINDS:
        return KINDS[kind]()
    if kind in BOUNDS:
        made, name = BOUNDS[kind]
        return made(str(context[name]).replace(" or ", ", "))
    return Foreign(words)


def _refused(keys: Keys, problem: Reason, value: Any) -> Reason:
    """A problem, and the value where it is short and not secret."""
    secret = any(part in str(key) for key in keys for part in SECRET)
    if secret or not isinstance(value, (str, int, float)):
        return BadSetting(problem)
    return BadValueOf(problem, repr(value)[:40])
