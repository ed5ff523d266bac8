"""Errors of trees, with line, node path and a hint.

TreeError                a tree that cannot be loaded (or the root of what follows)
└── TickError            a node that cannot go on while it is ticked or halted
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from typing import Any, TypeVar

from tms_reason.errors import TaskError
from tms_reason.reason import Reason
from tms_reason.texts import text
from tms_ts.tree_reasons import (
    AtNode,
    DidYouMean,
    FileLine,
    FileLineAt,
    Hinted,
    InFile,
    InTemplate,
    Line,
    LineAt,
    Placed,
)

R = TypeVar("R", bound=Reason)
MAX_WARNINGS = 500  # of one tree; more are no help to the author
MAX_LISTED = 12  # names in one text
MAX_NAMES = 1000  # names among which a near one is searched, which takes some 30 ms


class TreeError(TaskError):
    """A tree document that is refused, with the place to look at."""

    def __init__(
        self,
        what: Reason,
        *,
        line: int | None = None,
        path: str = "",
        hint: Reason | None = None,
        file: str = "",
        template: str = "",
    ) -> None:
        super().__init__(what, self.code)
        self.what, self.hint, self.file = shortened(what), hint if hint is None else shortened(hint), file
        self.line: int | None = None
        self.path = self.template = ""
        self.place(line, path, template)

    def place(self, line: int | None, path: str, template: str = "") -> None:
        """Set where it is: line of the task, path of the node, and the place in a template that the task calls."""
        self.line, self.path, self.template = line, path, template
        where = _place(self.file, line, short(path, 120))
        what = within(template, self.what)
        placed = what if where is None else Placed(where, what)
        self.reason = placed if self.hint is None else Hinted(placed, self.hint)

    def __str__(self) -> str:
        return text(self.reason, "en")


class TickError(TreeError):
    """A node that raised; the caller halts the tree."""


def within(template: str, what: Reason) -> Reason:
    """A reason about a node; `template`: where it stands in a template (TEMPLATE:LINE), empty in the task itself."""
    return InTemplate(template, what) if template else what


def short(text: str, length: int = 400) -> str:
    """A text cut to a length that a person reads; documents can hold names of megabytes."""
    return text if len(text) <= length else text[: length - 3] + "..."


def shortened(reason: R) -> R:
    """A reason whose texts have lengths that a person reads."""
    return type(reason)(**{name: _short(value) for name, value in reason.args.items()})


def _short(value: Any) -> Any:
    if isinstance(value, tuple):
        return (*map(_short, value[:MAX_LISTED]), *(["..."] if len(value) > MAX_LISTED else []))
    if isinstance(value, Reason):
        return shortened(value)
    return short(value, 100) if isinstance(value, str) else value


def _place(file: str, line: int | None, path: str) -> Reason | None:
    if line:
        if file:
            return FileLineAt(line, path, file) if path else FileLine(line, file)
        return LineAt(line, path) if path else Line(line)
    if file:
        return InFile(file)
    return AtNode(path) if path else None


def did_you_mean(word: str, known: Iterable[str]) -> Reason | None:
    """The name that was perhaps meant."""
    names = list(known)
    if len(word) > 100 or len(names) > MAX_NAMES:
        return None
    near = difflib.get_close_matches(word, names, n=1, cutoff=0.6)
    return DidYouMean(near[0]) if near else None
