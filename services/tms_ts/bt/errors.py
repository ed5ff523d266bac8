"""What can go wrong with a tree, told with line, node path and a hint.

TreeError                a tree that cannot be loaded (or the root of what follows)
└── TickError            a node that cannot go on while it is ticked or halted
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable

from tms_reason.errors import TaskError

MAX_WARNINGS = 500  # of one tree; more than that helps nobody
MAX_NAMES = 1000  # to look for a near one among, which takes some 30 ms


class TreeError(TaskError):
    """A tree document that is refused, with the place to look at."""

    def __init__(
        self, message: str, *, line: int | None = None, path: str = "", hint: str = "", file: str = ""
    ) -> None:
        message = short(message)
        super().__init__(message)
        self.message = message
        self.line = line
        self.path = path
        self.hint = short(hint)
        self.file = file

    def __str__(self) -> str:
        place = ", ".join(
            part
            for part in (
                self.file,
                f"line {self.line}" if self.line else "",
                f"at {short(self.path, 120)}" if self.path else "",
            )
            if part
        )
        text = f"{place}: {self.message}" if place else self.message
        return f"{text} ({self.hint})" if self.hint else text


class TickError(TreeError):
    """A node that raised; the caller halts the tree."""


def short(text: str, length: int = 400) -> str:
    """A text cut to a length that a person reads; documents can hold names of megabytes."""
    return text if len(text) <= length else text[: length - 3] + "..."


def did_you_mean(word: str, known: Iterable[str]) -> str:
    names = list(known)
    if len(word) > 100 or len(names) > MAX_NAMES:
        return ""
    near = difflib.get_close_matches(word, names, n=1, cutoff=0.6)
    return f"did you mean {near[0]!r}?" if near else ""
