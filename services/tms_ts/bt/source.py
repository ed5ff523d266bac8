"""From a task's bytes to XML elements that know their line in the file.

Attribute values keep their line breaks, as in the library's parser (an XML parser would turn them into blanks).
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from pathlib import Path

from lxml import etree

from tms_reason import xml_text
from tms_reason.xml_text import MAX_BYTES
from tms_ts.bt.errors import TreeError
from tms_ts.tree_reasons import ChooseGrootFile, FileTooLarge, NoFile, NotXml, TaskFilesAreSmall

_MARKUP = re.compile(
    r"<!--.*?-->|<!\[CDATA\[.*?\]\]>|<\?.*?\?>|<(?:[^<>\"']|\"[^\"]*\"|'[^']*')*>", re.DOTALL
)  # fmt: skip
_QUOTED = re.compile(r"\"[^\"]*\"|'[^']*'")
_BREAK = re.compile(r"=\s*(?:\"[^\"<]*[\n\t]|'[^'<]*[\n\t])")
LAST_LINE = 65_535  # the last line that lxml can store at an element
_PRIVATE = range(0xE000, 0xF8FF)


@dataclass(frozen=True, slots=True)
class ParsedXml:
    """One parsed document."""

    root: etree._Element
    text: str
    marks: tuple[str, str]  # stand for a line break and a tab in attribute values
    file: str = ""

    def attributes(self, element: etree._Element) -> dict[str, str]:
        found = {str(key): str(value) for key, value in element.items()}
        line_break, tab = self.marks
        if line_break:
            for key, value in found.items():
                found[key] = value.replace(line_break + " ", "\n").replace(tab + " ", "\t")
        return found


def settled(source: ParsedXml) -> ParsedXml:
    """The document with its line breaks in the elements themselves, so that elements of others fit into it."""
    if source.marks[0]:
        for element in source.root.iter("*"):
            for key, value in source.attributes(element).items():
                element.set(key, value)
    return replace(source, marks=("", ""))


def set_line(element: etree._Element, line: int) -> None:
    """Say in which line an element begins."""
    setattr(element, "sourceline", min(line, LAST_LINE))  # noqa: B010 - the stubs call it read-only


def line_of(element: etree._Element) -> int:
    """The line of an element in its file; 0 when the parser does not know it."""
    line: object = element.sourceline
    return line if isinstance(line, int) else 0


def read_file(path: Path, limit: int = MAX_BYTES) -> bytes:
    """The bytes of a file.

    Raises:
        TreeError: there is no such file, or it is larger than `limit` [bytes].
    """
    if not path.is_file():
        raise TreeError(NoFile(str(path)))
    with path.open("rb") as file:
        data = file.read(limit + 1)
    if len(data) > limit:
        raise TreeError(FileTooLarge(path.name, limit), hint=TaskFilesAreSmall())
    return data


def _keep_breaks(text: str) -> tuple[str, tuple[str, str]]:
    """Put marks before line breaks and tabs in attribute values; line numbers do not change."""
    if _BREAK.search(text) is None:
        return text, ("", "")
    free = [mark for mark in map(chr, _PRIVATE) if mark not in text][:2]
    if len(free) < 2:
        return text, ("", "")
    line_break, tab = free

    def in_value(found: re.Match[str]) -> str:
        return found[0].replace("\n", line_break + "\n").replace("\t", tab + "\t")

    def in_markup(found: re.Match[str]) -> str:
        return found[0] if found[0][1] in "!?" else _QUOTED.sub(in_value, found[0])

    return _MARKUP.sub(in_markup, text), (line_break, tab)


def _set_lines(root: etree._Element, text: str) -> None:
    """Set the line where each start tag begins, as people expect it; the parser gives the line where the tag ends."""
    tags = [found for found in _MARKUP.finditer(text) if found[0][1] not in "!?/"]
    if not any("\n" in found[0] for found in tags):
        return
    line = 1
    position = 0
    for element, found in zip(root.iter("*"), tags, strict=False):
        line += text.count("\n", position, found.start())
        position = found.start()
        set_line(element, line)


def parse(data: bytes | str, *, file: str = "", limit: int = MAX_BYTES) -> ParsedXml:
    """Parse XML from outside.

    Raises:
        TreeError: it is too large, not in a known encoding, or no well-formed XML; with the line.
    """
    try:
        text = xml_text.decode(data, limit)
        if "<" not in text:
            raise TreeError(NotXml(), hint=ChooseGrootFile())
        root = xml_text.elements(text, comments=False)  # well-formed from here on, so the patterns take linear time
        marked, marks = _keep_breaks(text)
        if marked is not text:
            root = xml_text.elements(marked, comments=False)
    except xml_text.XmlRefused as refused:
        raise TreeError(refused.what, line=refused.line, hint=refused.hint, file=file) from refused
    _set_lines(root, text)
    return ParsedXml(root, text, marks, file)
