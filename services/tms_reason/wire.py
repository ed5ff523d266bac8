"""Reasons as one string `CODE key=value ...` with JSON values, for messages with a string for a reason.

A string of another form becomes the reason `FOREIGN words=...`.
"""

import importlib
import json
import re
import typing
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

from tms_reason.reason import REGISTRY, Foreign, Reason, Unknown

CODE = re.compile(r"[A-Z][A-Z0-9_]*(?= [a-z_0-9]+=|$)")
KEY = re.compile(r" ([a-z_0-9]+)=")
DEEPEST = 8  # reasons inside each other
DECODER = json.JSONDecoder()


def to_line(reason: Reason | None) -> str:
    """A reason as one line for a message; empty for no reason."""
    if reason is None:
        return ""
    words = (f" {name}={json.dumps(_plain(value), ensure_ascii=False)}" for name, value in reason.args.items())
    return reason.code + "".join(words)


def of(line: str) -> Reason | None:
    """The reason that a message carries; None when it is empty."""
    if not line:
        return None
    found = CODE.match(line)
    args = None if found is None else _arguments(line, found.end())
    if found is None or args is None:
        return Foreign(line)
    return _made(found.group(), args, 0)


def known(line: str) -> Reason:
    """Like `of`, for a string that is not empty."""
    reason = of(line)
    assert reason is not None, "a reason was promised"
    return reason


def refusal(error_code: str, error_msg: str) -> Reason:
    """The reason of a service's refusal; a text of another system keeps its code."""
    reason = of(error_msg)
    if reason is None or isinstance(reason, Foreign):
        return Foreign(f"{error_code}: {error_msg}")
    return reason


def to_data(reason: Reason) -> dict[str, Any]:
    """A reason for JSON documents: `{"code": ..., "args": {...}}`."""
    return {"code": reason.code, "args": {name: _plain(value) for name, value in reason.args.items()}}


def of_data(data: Mapping[str, Any]) -> Reason:
    """The reason of `to_data`."""
    return _made(str(data.get("code")), dict(data.get("args") or {}), 0)


@cache
def load() -> None:
    """Import all modules of reasons, so that all codes are known; they import nothing but each other."""
    services = Path(__file__).resolve().parent.parent
    for path in sorted(services.glob("tms_*/*reasons.py")):
        importlib.import_module(".".join(path.relative_to(services).with_suffix("").parts))


def _plain(value: Any) -> Any:
    if isinstance(value, Reason):
        return to_data(value)
    return [_plain(one) for one in value] if isinstance(value, (tuple, list)) else value


def _arguments(line: str, at: int) -> dict[str, Any] | None:
    args: dict[str, Any] = {}
    while at < len(line):
        key = KEY.match(line, at)
        if key is None:
            return None
        try:
            args[key.group(1)], at = DECODER.raw_decode(line, key.end())
        except (json.JSONDecodeError, RecursionError):
            return None
    return args


def _made(code: str, args: dict[str, Any], depth: int) -> Reason:
    kind = REGISTRY.get(code)
    if kind is None:
        load()
        kind = REGISTRY.get(code)
    hints = _hints(code) if kind is not None else {}
    if kind is None or depth > DEEPEST or set(args) != set(hints):
        return Unknown(code, json.dumps(args, ensure_ascii=False))
    values = {name: _value(hints[name], value, depth) for name, value in args.items()}
    if any(value is WRONG for value in values.values()):
        return Unknown(code, json.dumps(args, ensure_ascii=False))
    return kind(**values)


WRONG = object()  # mark for a value of another type than declared


@cache
def _hints(code: str) -> dict[str, Any]:
    """The declared types of a code's arguments, in their order."""
    found = typing.get_type_hints(REGISTRY[code])
    return {name: found[name] for name in REGISTRY[code].parameters}


def _value(wanted: Any, value: Any, depth: int) -> Any:
    """A value in the type of its annotation; WRONG if it does not fit."""
    options = typing.get_args(wanted) if _is_union(wanted) else (wanted,)
    for option in options:
        found = _as(option, value, depth)
        if found is not WRONG:
            return found
    return WRONG


def _is_union(wanted: Any) -> bool:
    return type(wanted).__name__ == "UnionType" or typing.get_origin(wanted) is typing.Union


def _as(option: Any, value: Any, depth: int) -> Any:
    if option is Any:
        return value
    if option in (None, type(None)):
        return None if value is None else WRONG
    if typing.get_origin(option) is tuple:
        inner = typing.get_args(option)[0]
        parts = [_value(inner, one, depth) for one in value] if isinstance(value, list) else [WRONG]
        return WRONG if any(part is WRONG for part in parts) else tuple(parts)
    if isinstance(option, type) and issubclass(option, Reason):
        return _nested(option, value, depth)
    if option is float and isinstance(value, int) and not isinstance(value, bool):
        return float(value)
    return value if type(value) is option else WRONG


def _nested(option: type[Reason], value: Any, depth: int) -> Any:
    if not isinstance(value, dict) or set(value) != {"code", "args"} or not isinstance(value["args"], dict):
        return WRONG
    found = _made(str(value["code"]), value["args"], depth + 1)
    return found if isinstance(found, option) else WRONG
