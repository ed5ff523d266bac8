"""Reads a cases file; what is wrong with it is told in one line, with the number of the line in the file."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

Case = dict[str, Any]
KEYS = {"id": str, "xml": str, "ticks": int, "expected": dict}
RECORDED = {"nodes": list, "bb_init": list, "trace": list}


class BadCases(Exception):
    """The file cannot be replayed."""


def read_cases(path: Path) -> list[Case]:
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise BadCases(f"{path}: cannot be read ({error.strerror})") from error
    except UnicodeDecodeError as error:
        raise BadCases(f"{path}: is not UTF-8 text (byte {error.start})") from error
    cases = [read_case(line, f"{path}:{number}") for number, line in enumerate(text.split("\n"), 1) if line.strip()]
    if not cases:
        raise BadCases(f"{path}: there are no cases in it")
    return cases


def read_case(line: str, place: str) -> Case:
    try:
        case = json.loads(line)
    except ValueError as error:
        raise BadCases(f"{place}: this is not JSON ({error})") from error
    if not isinstance(case, dict):
        raise BadCases(f"{place}: a case is a JSON object, this is a {type(case).__name__}")
    must_have(case, KEYS, place)
    if "load_error" not in case["expected"]:
        must_have(case["expected"], RECORDED, f"{place}: expected")
    at_ms = case.get("at_ms")
    if at_ms and len(at_ms) < case["ticks"]:
        raise BadCases(f"{place}: at_ms has {len(at_ms)} times for {case['ticks']} ticks")
    return case


def must_have(data: dict[str, Any], keys: dict[str, type], place: str) -> None:
    for key, kind in keys.items():
        if not isinstance(data.get(key), kind):
            raise BadCases(f"{place}: {key!r} must be there and be a {kind.__name__}")
