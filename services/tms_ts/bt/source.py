"""From bytes to XML elements: everything a hostile or broken file can do ends here, in one clear error.

Attribute values keep their line breaks, as in the library's parser (an XML parser would turn them into blanks).
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from lxml import etree

from tms_ts.bt.errors import TreeError

MAX_BYTES = 5_000_000
MAX_TAGS = 200_000  # "<" in the text; bounds the memory that the parser takes
MAX_DEPTH = 200
MAX_EQUALS = 5000  # "=" in one tag; the parser compares attribute names pairwise

_MARKUP = re.compile(
    r"<!--.*?-->|<!\[CDATA\[.*?\]\]>|<\?.*?\?>|<(?:[^<>\"']|\"[^\"]*\"|'[^']*')*>", re.DOTALL
)  # fmt: skip
_QUOTED = re.compile(r"\"[^\"]*\"|'[^']*'")
_PROLOG = re.compile(r"\s+|<\?.*?\?>|<!--.*?-->", re.DOTALL)
_DECLARATION = re.compile(r"<\?xml\s.*?\?>", re.DOTALL)
_BREAK = re.compile(r"=\s*(?:\"[^\"<]*[\n\t]|'[^'<]*[\n\t])")
_PRIVATE = range(0xE000, 0xF8FF)


@dataclass(frozen=True, slots=True)
class Source:
    """One parsed document."""

    root: etree._Element
    text: str
    marks: tuple[str, str]  # stand for a line break and a tab in attribute values
    file: str = ""

    def attributes(self, element: etree._Element) -> dict[str, str]:
        found = {str(key): str(value) for key, value in element.attrib.items()}
        line_break, tab = self.marks
        if line_break:
            for key, value in found.items():
                found[key] = value.replace(line_break + " ", "\n").replace(tab + " ", "\t")
        return found


def line_of(element: etree._Element) -> int:
    line: object = element.sourceline
    return line if isinstance(line, int) else 0


def read_file(path: Path, limit: int = MAX_BYTES) -> bytes:
    if not path.is_file():
        raise TreeError(f"there is no file {path}")
    with path.open("rb") as file:
        data = file.read(limit + 1)
    if len(data) > limit:
        raise TreeError(f"{path.name} is larger than {limit} bytes", hint="a task file has some 10 to 100 kB")
    return data


def decode(data: bytes | str, limit: int = MAX_BYTES) -> str:
    """Text with plain line feeds; bytes are UTF-8 whatever the XML declaration says."""
    if len(data) > limit:
        raise TreeError(f"the tree is larger than {limit} bytes", hint="a task file has some 10 to 100 kB")
    if isinstance(data, bytes):
        raw = data
        try:
            data = raw.decode("utf-8-sig")
        except UnicodeDecodeError as error:
            line = raw.count(b"\n", 0, error.start) + 1
            raise TreeError("the text is not UTF-8", line=line, hint="save the file as UTF-8") from error
    text = data.removeprefix("\ufeff").replace("\r\n", "\n").replace("\r", "\n")
    zero = text.find("\0")
    if zero >= 0:
        raise TreeError("the text contains a NUL byte", line=text.count("\n", 0, zero) + 1)
    if not text.strip():
        raise TreeError("the text is empty", hint='a tree begins with <root main_tree_to_execute="...">')
    return text


def _refuse_dtd(text: str) -> None:
    position = 0
    while (found := _PROLOG.match(text, position)) is not None:
        position = found.end()
    if text.startswith("<!DOCTYPE", position):
        line = text.count("\n", 0, position) + 1
        raise TreeError("a document type (DTD) is not allowed", line=line, hint="remove <!DOCTYPE ...>")


def _keep_breaks(text: str) -> tuple[str, tuple[str, str]]:
    """Put marks before line breaks and tabs in attribute values; line numbers stay what they are."""
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
    """The parser tells the line where a start tag ends; people look for the one where it begins."""
    tags = [found for found in _MARKUP.finditer(text) if found[0][1] not in "!?/"]
    if not any("\n" in found[0] for found in tags):
        return
    line = 1
    position = 0
    for element, found in zip(root.iter("*"), tags, strict=False):
        line += text.count("\n", position, found.start())
        position = found.start()
        setattr(element, "sourceline", line)  # noqa: B010 - the stubs call it read-only


def parse(data: bytes | str, *, file: str = "", limit: int = MAX_BYTES) -> Source:
    text = decode(data, limit)
    _refuse_dtd(text)
    if "<" not in text:
        raise TreeError("this is not XML", hint="a tree begins with <root ...>; give a Path to load a file")
    if text.count("<") > MAX_TAGS:
        raise TreeError(f"the text has more than {MAX_TAGS} tags", file=file)
    if max(tag.count("=") for tag in text.split("<")) > MAX_EQUALS:
        raise TreeError("an element has too many attributes", file=file)
    root = _elements(text, file)  # well-formed from here on, so the patterns below take linear time
    marked, marks = _keep_breaks(text)
    if marked is not text:
        root = _elements(marked, file)
    _set_lines(root, text)
    return Source(root, text, marks, file)


def _elements(text: str, file: str) -> etree._Element:
    declaration = _DECLARATION.match(text)
    if declaration is not None:  # its encoding would be believed; keep the lines
        text = "\n" * declaration[0].count("\n") + text[declaration.end() :]
    parser = etree.XMLParser(
        encoding="utf-8", resolve_entities=False, load_dtd=False, no_network=True, huge_tree=False,
        remove_comments=True, remove_pis=True,
    )  # fmt: skip
    try:
        return etree.fromstring(text.encode("utf-8", "surrogatepass"), parser)
    except etree.XMLSyntaxError as error:
        message = str(error.msg or "malformed").split(", line ")[0]
        line = error.lineno or 1
        if "depth" in message:
            raise TreeError(f"the elements are nested deeper than {MAX_DEPTH}", line=line, file=file) from error
        if "XML_PARSE_HUGE" in message:
            raise TreeError("a name or a value is too long", line=line, file=file) from error
        raise TreeError(f"this is not well-formed XML: {message}", line=line, file=file) from error
