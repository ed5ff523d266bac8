"""Expressions over blackboard values: names, numbers, "texts", true, false, == != < > <= >=, and, or, parentheses.

simpleeval evaluates them and allows only these operations. The rules are those of the C++ system: every part is
evaluated (no short cut), a key without a value is the empty text, text compares with text and numbers with numbers
(true is 1), and an expression that breaks this is invalid as a whole. Ours: a text in quotes that is a number counts as
one beside a number, since a counter may be kept as either.
"""

from __future__ import annotations

import ast
import operator
import re
import threading
from collections.abc import Callable
from functools import lru_cache
from typing import Any

from simpleeval import InvalidExpression, SimpleEval  # type: ignore[import-untyped,unused-ignore]

from tms_reason.reason import Reason
from tms_reason.texts import text
from tms_ts.tree_reasons import (
    ConstantNoNumber,
    ExpressionInvalid,
    ExpressionSigns,
    ExpressionTooLong,
    ExpressionUnreadable,
    KeyWithoutValue,
    NameBeginsWithDigit,
    OnlyComparisons,
    OnlyNumbersNegative,
    TextCompared,
    TextCountsHere,
)

MAX_LENGTH = 4000
MAX_NESTING = 60
_ALLOWED = re.compile(r"[\w\s()=!<>.\-]*", re.ASCII)
_IDENTIFIER = re.compile(r"(?<![\w.])[A-Za-z_]\w*", re.ASCII)
_NUMBER = re.compile(r"(?<![\w.])0*(?!0[0-9])([0-9]+(?:\.[0-9]*)?(?:[eE]-?[0-9]+)?)(and|or|)(?![\w.])", re.ASCII)
WHOLE_NUMBER = re.compile(r"-?[0-9]{1,15}(?:\.[0-9]{1,15})?", re.ASCII)
_NO_NUMBER = re.compile(r"(?<![\w.])[0-9][0-9.]*(?![eE]-?[0-9]+(?![\w.]))[A-Za-z_]", re.ASCII)
_WORDS = frozenset({"and", "or"})
_PREFIX = "k_"  # a prefix, so that no key is a word of Python
TRUTH = {"true": True, "false": False}

_local = threading.local()  # one evaluator per thread: making one costs more than most expressions

Lookup = Callable[[str], Any]  # value of a key, "" if there is none
Scalar = str | bool | int | float


class Invalid(Exception):
    """The expression cannot be evaluated; for a condition that is a failure."""

    def __init__(self, why: Reason) -> None:
        super().__init__(text(why, "en"))
        self.why = why


@lru_cache(maxsize=1024)
def parse(text: str) -> ast.expr:
    """The syntax tree of an expression; Invalid if it is none."""
    if len(text) > MAX_LENGTH or text.count("(") > MAX_NESTING or text.count("-") > MAX_NESTING:
        raise Invalid(ExpressionTooLong())
    parts = text.split('"')  # every second one is a text in quotes
    if len(parts) % 2 == 0:
        raise Invalid(ExpressionSigns())
    python = "".join(f"({part!r})" if number % 2 else _python(part) for number, part in enumerate(parts))
    try:
        body = ast.parse(python.strip(), mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        raise Invalid(ExpressionUnreadable()) from error
    return body


def _python(part: str) -> str:
    """An expression, or a part of one between texts, as Python writes it."""
    if not _ALLOWED.fullmatch(part):
        raise Invalid(ExpressionSigns())
    flat = _NUMBER.sub(r"\1 \2", " ".join(part.split()))  # 01 is 1, and "1and" is two words, as in C++
    if _NO_NUMBER.search(flat):
        raise Invalid(NameBeginsWithDigit())
    return _IDENTIFIER.sub(lambda word: word[0] if word[0] in _WORDS else _PREFIX + word[0], flat)


def names(text: str) -> frozenset[str]:
    """The keys that an expression reads; Invalid if it is none."""
    found = {node.id.removeprefix(_PREFIX) for node in ast.walk(parse(text)) if isinstance(node, ast.Name)}
    return frozenset(found - TRUTH.keys())


def beside_numbers(text: str) -> dict[str, str]:
    """Keys that an expression compares with a text in quotes that is a number, and that text."""
    found: dict[str, str] = {}
    for node in ast.walk(parse(text)):
        sides = [node.left, *node.comparators] if isinstance(node, ast.Compare) else []
        texts = [one.value for one in sides if isinstance(one, ast.Constant) and isinstance(one.value, str)]
        for number in filter(WHOLE_NUMBER.fullmatch, texts):
            found.update((one.id.removeprefix(_PREFIX), number) for one in sides if isinstance(one, ast.Name))
    return found


class _Quoted(str):
    """A text in quotes."""

    __slots__ = ()


class _Evaluator(SimpleEval):  # type: ignore[misc,unused-ignore]
    """simpleeval, reduced to comparisons and logic, with the C++ system's rules for types."""

    lookup: Lookup
    warn: Callable[[Reason], None]

    def __init__(self) -> None:
        super().__init__(operators={}, functions={}, names={})
        self.nodes = {
            ast.Constant: self.constant,
            ast.Name: self.name,
            ast.Compare: self.compare,
            ast.BoolOp: self.logic,
            ast.UnaryOp: self.minus,
        }

    def constant(self, node: ast.Constant) -> Scalar:
        if not isinstance(node.value, int | float | str):
            raise Invalid(ConstantNoNumber(repr(node.value)))
        return _Quoted(node.value) if isinstance(node.value, str) else node.value

    def name(self, node: ast.Name) -> Scalar:
        key = node.id.removeprefix(_PREFIX)
        if key in TRUTH:
            return TRUTH[key]
        value = self.lookup(key)
        return round(value, 6) if isinstance(value, float) else value if isinstance(value, Scalar) else ""

    def minus(self, node: ast.UnaryOp) -> Scalar:
        value: Scalar = self._eval(node.operand)
        if not isinstance(node.op, ast.USub) or isinstance(value, str):
            raise Invalid(OnlyNumbersNegative())
        return -value

    def logic(self, node: ast.BoolOp) -> bool:
        values = [self.truth(self._eval(part)) for part in node.values]  # all of them, as in C++
        return all(values) if isinstance(node.op, ast.And) else any(values)

    def compare(self, node: ast.Compare) -> bool:
        left = self._eval(node.left)
        for op, part in zip(node.ops, node.comparators, strict=True):
            left = self.compare_two(op, left, self._eval(part))
        return bool(left)

    def compare_two(self, op: ast.cmpop, left: Scalar, right: Scalar) -> bool:
        if isinstance(left, str) != isinstance(right, str):
            left, right = self.as_bool(left, right), self.as_bool(right, left)
        function = _COMPARISONS.get(type(op))
        if function is None or (isinstance(left, str) and not isinstance(op, ast.Eq | ast.NotEq)):
            raise Invalid(OnlyComparisons())
        return bool(function(left, right))

    def as_bool(self, value: Scalar, other: Scalar) -> Scalar:
        """Read a text as a boolean beside a boolean, one in quotes as a number beside a number; else it is invalid."""
        if not isinstance(value, str):
            return value
        if isinstance(other, bool) and value in TRUTH:
            self.warn(TextCountsHere(value))
            return TRUTH[value]
        if isinstance(value, _Quoted) and not isinstance(other, bool) and WHOLE_NUMBER.fullmatch(value):
            self.warn(TextCountsHere(value))
            return float(value)
        raise Invalid(TextCompared(value, repr(other)) if value else KeyWithoutValue())

    def truth(self, value: Scalar) -> bool:
        return bool(self.as_bool(value, True))


_COMPARISONS: dict[type[ast.cmpop], Callable[[Any, Any], Any]] = {
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Lt: operator.lt,
    ast.Gt: operator.gt,
    ast.LtE: operator.le,
    ast.GtE: operator.ge,
}


def evaluate(text: str, lookup: Lookup, warn: Callable[[Reason], None] = lambda what: None) -> bool:
    """Whether an expression is true; raises Invalid if it cannot be evaluated."""
    evaluator: _Evaluator | None = getattr(_local, "evaluator", None)
    if evaluator is None:
        evaluator = _local.evaluator = _Evaluator()
    evaluator.lookup, evaluator.warn = lookup, warn
    try:
        return evaluator.truth(evaluator.eval(text, parse(text)))
    except InvalidExpression as error:
        raise Invalid(ExpressionInvalid(str(error))) from error
