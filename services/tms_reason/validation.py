"""Turns pydantic's findings about data into reasons, each with its key."""

from collections.abc import Iterator
from typing import Any

from pydantic import ValidationError

from tms_reason.reason import Foreign, Reason
from tms_reason.reasons import BadSetting, BadValueOf, MissingKey, UnknownKey
from tms_reason.texts import sentence, text

Keys = tuple[int | str, ...]
PLAIN: dict[str, type[UnknownKey | MissingKey]] = {"extra_forbidden": UnknownKey, "missing": MissingKey}
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
            yield keys, _refused(keys, one["msg"], one["input"])


def explain(error: ValidationError) -> str:
    """The first problem of a validation as `key: text`, and the number of further ones."""
    keys, reason = next(problems(error))
    key, more = dotted(keys), error.error_count() - 1
    return (f"{key}: " if key else "") + text(reason, "en") + (f" (and {more} more)" if more else "")


def dotted(keys: Keys) -> str:
    """A key as people write it: `machines.zx200.model`."""
    return ".".join(str(part) for part in keys)


def _refused(keys: Keys, words: str, value: Any) -> Reason:
    """Pydantic's own text, and the value where it is short and not secret."""
    secret = any(part in str(key) for key in keys for part in SECRET)
    if secret or not isinstance(value, (str, int, float)):
        return BadSetting(Foreign(words))
    return BadValueOf(Foreign(words), repr(value)[:40])
