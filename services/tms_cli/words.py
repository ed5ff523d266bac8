"""The texts of `tms` for people, in the language of the user's locale (LC_ALL, LC_MESSAGES, LANG: ja*).

The English text in the code is the key of its Japanese in the catalogues (tms_reason/locale/ja/tms_cli*.po). JSON
output is never translated.
"""

import os
import unicodedata
from typing import Any

import click

from tms_reason import texts, wire
from tms_reason.reason import Reason


def japanese() -> bool:
    """Whether the locale asks for Japanese."""
    names = (os.environ.get(key) for key in ("LC_ALL", "LC_MESSAGES", "LANG"))
    return next((name.startswith("ja") for name in names if name), False)


def say(english: str, **values: Any) -> str:
    """A line for people; `english` is a format string with the values' names."""
    return texts.translated(english, language()).format(**values)


def language() -> str:
    """The language for the texts of reasons."""
    return "ja" if japanese() else "en"


def reason(line: str) -> str:
    """The text of a reason in a message; empty for none."""
    found = wire.of(line)
    return "" if found is None else texts.text(found, language())


def sentence(found: Reason) -> str:
    """The text of a reason."""
    return texts.text(found, language())


def with_command(found: Reason) -> str:
    """The text of a reason, with the command that helps, if one does."""
    remedy = texts.remedy_of(found)
    return texts.sentence(found, language()) if remedy is not None and remedy[1] else sentence(found)


def with_advice(line: str) -> str:
    """Like `reason`, and what to do about it."""
    found = wire.of(line)
    return "" if found is None else texts.sentence(found, language())


def english(line: str) -> str:
    """Like `reason`, for JSON, which is never translated."""
    found = wire.of(line)
    return "" if found is None else texts.text(found, "en")


def state(word: str) -> str:
    """The state of a run or a node."""
    return texts.translated(word, language())


def padded(text: str, width: int) -> str:
    """A text, filled with spaces to this width in columns."""
    return text + " " * (width - columns(text))


def help_text(english: str) -> str:
    """The help text of a paragraph or an option."""
    folded = " ".join(english.split())
    shown = texts.translated(folded, language())
    return english if shown == folded else shown


def columns(text: str) -> int:
    """The width of a text on a terminal: Japanese characters take two columns."""
    return sum(2 if unicodedata.east_asian_width(letter) in "WF" else 1 for letter in text)


class Formatter(click.HelpFormatter):
    """click's help pages with translated headings."""

    def write_usage(self, prog: str, args: str = "", prefix: str | None = None) -> None:
        super().write_usage(prog, args, prefix or f"{_heading('Usage')}: ")

    def write_heading(self, heading: str) -> None:
        super().write_heading(_heading(heading))

    def write_text(self, text: str) -> None:
        super().write_text("\n\n".join(self._paragraph(part) for part in text.split("\n\n")))

    def write_dl(self, rows: Any, col_max: int = 30, col_spacing: int = 2) -> None:
        super().write_dl([(name, _option(text)) for name, text in rows], col_max, col_spacing)

    def _paragraph(self, text: str) -> str:
        if text.startswith("\b"):
            for heading in ("Examples:", "Example:"):
                text = text.replace(f"\b\n{heading}", f"\b\n{_heading(heading)}", 1)
            return text
        shown = help_text(text)
        return text if shown == text else "\b\n" + _folded(shown, self.width - self.current_indent - 2)


class Group(click.Group):
    """A group whose list of verbs is in the language of the locale, too."""

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        verbs = [(name, self.get_command(ctx, name)) for name in self.list_commands(ctx)]
        with formatter.section("Commands"):
            formatter.write_dl([(name, _summary(verb)) for name, verb in verbs if verb is not None])


def _summary(verb: click.Command) -> str:
    """The first sentence of a verb's help."""
    if not japanese():
        return verb.get_short_help_str(70)
    return help_text((verb.help or "").split("\n\n")[0]).split("。")[0]


def _heading(english: str) -> str:
    return texts.translated(english, language())


def _option(english: str) -> str:
    """The help of an option; click adds `[required]` or `[default: 20]` after it."""
    text, extra, more = english.partition("  [")
    whole = help_text(english)
    return whole if whole != english else help_text(text) + extra + more


def _folded(text: str, width: int) -> str:
    """Break the lines of a Japanese text, which has no spaces to break at."""
    lines = [""]
    for letter in text:
        if columns(lines[-1] + letter) > width and letter not in "。、)」":
            lines.append("")
        lines[-1] += letter
    return "\n".join(lines)
