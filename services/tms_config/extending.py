"""Borders that extend another one of their machine: `opera: {extends: sim, base_frame: base_link}`."""

from collections.abc import Mapping
from typing import Any

from tms_config import reasons
from tms_reason.validation import Wrong

EXTENDS = "extends"


def extended(borders: Mapping[str, Any]) -> dict[str, Any]:
    """Every border with the keys of the border that it extends.

    A border's own key wins; a mapping, such as `sources`, is merged key by key; a key that is set to null is removed.

    Raises:
        Wrong: a border extends one that the machine does not have, or itself through others.
    """
    return {name: _whole(borders, name, ()) for name in borders}


def _whole(borders: Mapping[str, Any], name: str, below: tuple[str, ...]) -> Any:
    own = borders[name]
    if not isinstance(own, dict) or EXTENDS not in own:
        return own
    base = own[EXTENDS]
    if not isinstance(base, str) or base not in borders:
        raise Wrong(reasons.ExtendsNothing(str(base), tuple(borders)), "borders", name, EXTENDS)
    if base in (*below, name):
        raise Wrong(reasons.ExtendsItself(name), "borders", name, EXTENDS)
    merged = _merged(_whole(borders, base, (*below, name)), own)
    return {key: value for key, value in merged.items() if key != EXTENDS}


def _merged(base: Mapping[str, Any], own: Mapping[str, Any]) -> dict[str, Any]:
    """Merge one level deep: the settings of one source are never mixed from two borders."""
    both = {key: _present({**base[key], **own[key]}) for key in own if _mappings(base.get(key), own[key])}
    return _present({**base, **own, **both})


def _present(values: Mapping[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in values.items() if value is not None}


def _mappings(*values: object) -> bool:
    return all(isinstance(value, dict) for value in values)
