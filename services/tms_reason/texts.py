"""Makes texts of reasons for people; used only by command line, console and log.

The English text is declared with the reason. Other languages are gettext catalogues, a file a package and language
(`locale/ja/tms_rc.po`), which are read as text: an installation compiles nothing.
"""

import typing
from functools import cache
from pathlib import Path
from string import Formatter
from typing import Any

from babel.messages.pofile import read_po

from tms_reason.quantities import Unit
from tms_reason.reason import REGISTRY, Foreign, Reason
from tms_reason.remedies import EDIT_TASK

LOCALE = Path(__file__).resolve().parent / "locale"
LANGUAGES = ("en", "ja")
BETWEEN = {"en": "; ", "ja": "。"}  # separator of reasons in a list
COMMA = {"en": ", ", "ja": "、"}
FORMATTER = Formatter()


def text(reason: Reason, language: str) -> str:
    """One or more sentences without their last full stop."""
    return _filled(reason, translated(type(reason).text, language), language)


def details(reason: Reason, language: str) -> str:
    """The details for the search of a fault, of this reason and of those inside it."""
    own = _filled(reason, translated(type(reason).details, language), language) if type(reason).details else ""
    inner = [details(one, language) for one in _inside(reason)]
    return BETWEEN[language].join(filter(None, [own, *inner]))


def advice(reason: Reason, language: str) -> str:
    """What to do about a reason; empty when nothing helps."""
    remedy = remedy_of(reason)
    if remedy is None:
        return ""
    wanted, shown = remedy
    words = remedy_text(wanted, language)
    return f"{words}: `{shown}`" if shown else words


def remedy_text(reason: Reason, language: str) -> str:
    """The text of a reason's own remedy."""
    remedy = type(reason).remedy
    return "" if remedy is None else _filled(reason, translated(remedy.text, language), language)


def sentence(reason: Reason, language: str) -> str:
    """The text of a reason, and what to do about it."""
    return BETWEEN[language].join(filter(None, [text(reason, language), advice(reason, language)]))


def remedy_of(reason: Reason) -> tuple[Reason, str] | None:
    """The reason, among this one and those inside it, that has a remedy, and the command of the remedy.

    Its own comes first, but for that of every finding in a task: what is wrong there may lie elsewhere, as in a record.
    """
    remedy = type(reason).remedy
    if remedy is None or remedy is EDIT_TASK:
        inner = next((found for one in _inside(reason) if (found := remedy_of(one)) is not None), None)
        if inner is not None or remedy is None:
            return inner
    return reason, _filled(reason, remedy.command, "en")


def translated(english: str, language: str) -> str:
    """The text in a language; English where the catalogue has none."""
    return english if language == "en" else catalogue(language).get(english, english)


@cache
def catalogue(language: str) -> dict[str, str]:
    """All texts of a language by their English text."""
    found: dict[str, str] = {}
    for path in sorted((LOCALE / language).glob("*.po")):
        with path.open("rb") as file:
            for message in read_po(file, locale=language):
                if message.id and message.string:
                    found[str(message.id)] = str(message.string)
    return found


def _inside(reason: Reason) -> list[Reason]:
    found: list[Reason] = []
    for value in reason.args.values():
        found += [one for one in (value if isinstance(value, tuple) else (value,)) if isinstance(one, Reason)]
    return found


def _filled(reason: Reason, template: str, language: str) -> str:
    units = _units(reason.code)
    if isinstance(reason, Foreign):  # shown unchanged
        return reason.words
    shown = {name: _shown(value, units.get(name), language) for name, value in reason.args.items()}
    return FORMATTER.vformat(template, (), shown)


def _shown(value: Any, unit: Unit | None, language: str) -> str:
    if isinstance(value, Reason):
        return text(value, language)
    if isinstance(value, tuple):
        between = BETWEEN if any(isinstance(one, Reason) for one in value) else COMMA
        return between[language].join(_shown(one, unit, language) for one in value)
    if unit is not None and isinstance(value, (int, float)):
        return unit.show(value)
    return "" if value is None else _visible(str(value))


def _visible(text: str) -> str:
    """A text without line breaks and control characters, whatever another system has sent."""
    return text if text.isprintable() else "".join(one if one.isprintable() else repr(one)[1:-1] for one in text)


@cache
def _units(code: str) -> dict[str, Unit]:
    found: dict[str, Unit] = {}
    for name, hint in typing.get_type_hints(REGISTRY[code], include_extras=True).items():
        for part in (hint, *typing.get_args(hint)):
            found |= {name: mark for mark in getattr(part, "__metadata__", ()) if isinstance(mark, Unit)}  # noqa: B035
    return found
