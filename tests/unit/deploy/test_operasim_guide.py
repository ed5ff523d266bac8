"""The guide to OperaSim-PhysX says the same in both languages, and quotes messages as they are shown."""

import re

import pytest

from conftest import PROJECT
from tms_reason import texts, wire
from tms_reason.reason import REGISTRY

PAGES = {
    lang: (PROJECT / "deploy" / f"OPERASIM{end}.md").read_text("utf-8") for lang, end in (("en", ""), ("ja", ".ja"))
}


def commands(text: str) -> list[str]:
    blocks = re.findall(r"```sh\n(.*?)```", text, re.DOTALL)
    return [line.split(" #")[0].strip() for block in blocks for line in block.splitlines()]


def quoted(text: str) -> list[str]:
    """The messages of the section on `tms status`: the first column of its tables."""
    (section,) = re.findall(r"^## [^\n]*`tms status`[^\n]*\n(.*?)^## ", text, re.DOTALL | re.MULTILINE)
    return re.findall(r"^\| `([^`]+)` \|", section, re.MULTILINE)


def shown(lang: str) -> list[re.Pattern[str]]:
    """All reasons as patterns; those without words of their own would match everything."""
    wire.load()
    told = [texts.translated(kind.text, lang) for kind in REGISTRY.values() if kind.__module__.startswith("tms_")]
    bare = [one for one in told if len(re.sub(r"{\w+}|\W", "", one)) > 3]
    return [re.compile(re.sub(r"\\{\w+\\}", ".+", re.escape(one))) for one in bare]


def test_both_languages_have_the_same_commands_and_as_many_messages() -> None:
    assert len(commands(PAGES["en"])) == 7
    assert commands(PAGES["en"]) == commands(PAGES["ja"])
    assert len(quoted(PAGES["en"])) == len(quoted(PAGES["ja"])) == 24


@pytest.mark.parametrize("lang", PAGES)
def test_the_messages_are_those_that_are_shown(lang: str) -> None:
    known = shown(lang)
    assert [one for one in quoted(PAGES[lang]) if not any(pattern.fullmatch(one) for pattern in known)] == []
