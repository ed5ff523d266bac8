"""Formulas over blackboard values: numbers, {keys}, + - * / and parentheses, by simpleeval."""

from __future__ import annotations

import ast
import math
import operator
import re
from collections.abc import Callable
from typing import Any

from simpleeval import InvalidExpression, SimpleEval  # type: ignore[import-untyped,unused-ignore]

from tms_ts.nodes.expression import MAX_LENGTH, MAX_NESTING, Invalid
from tms_ts.tree_reasons import DividesByZero, ExpressionTooLong, FormulaUnreadable, ResultTooLarge

_KEY = re.compile(r"\{([^{}]+)\}")
_ALLOWED = re.compile(r"[0-9.\s+*/()-]*", re.ASCII)
_ZEROS = re.compile(r"(?<![0-9.])0+(?=[0-9])")
_OPERATORS: dict[type[ast.AST], Callable[..., Any]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv,
    ast.UAdd: operator.pos, ast.USub: operator.neg,
}  # fmt: skip


def parse(formula: str) -> tuple[ast.expr, list[str]]:
    """The syntax tree of a formula, in which v0, v1 ... are its keys; and these.

    Raises:
        Invalid: it is none.
    """
    if len(formula) > MAX_LENGTH or sum(map(formula.count, "(+-*/")) > MAX_NESTING:
        raise Invalid(ExpressionTooLong())
    parts = _KEY.split(formula)  # every second one is a key
    if not all(map(_ALLOWED.fullmatch, parts[::2])):
        raise Invalid(FormulaUnreadable())
    python = "".join(f"(v{number // 2})" if number % 2 else _ZEROS.sub("", part) for number, part in enumerate(parts))
    try:
        return ast.parse(" ".join(python.split()), mode="eval").body, parts[1::2]
    except (SyntaxError, ValueError) as error:
        raise Invalid(FormulaUnreadable()) from error


def keys_of(formula: str) -> list[str]:
    """The keys of a formula, also of one that cannot be read."""
    return _KEY.findall(formula)


def calculate(formula: str, value: Callable[[str], float]) -> float:
    """The result of a formula; `value` gives the number at a key.

    Raises:
        Invalid: it is no formula, divides by zero, or has no finite result.
    """
    body, keys = parse(formula)
    names = {f"v{number}": value(key) for number, key in enumerate(keys)}
    try:
        result = float(SimpleEval(operators=_OPERATORS, functions={}, names=names).eval(formula, body))
    except ZeroDivisionError as error:
        raise Invalid(DividesByZero()) from error
    except OverflowError as error:
        raise Invalid(ResultTooLarge()) from error
    except (InvalidExpression, TypeError) as error:  # a Python expression of these signs that is no formula: 1(2), ()
        raise Invalid(FormulaUnreadable()) from error
    if not math.isfinite(result):
        raise Invalid(ResultTooLarge())
    return result
