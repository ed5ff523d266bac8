"""XML from outside: a hostile or broken text is refused here, with its line.

Both readers of tasks use it: tms_db stores their text, tms_ts builds their trees.
"""

import re

from lxml import etree

from tms_reason.errors import TaskError
from tms_reason.reason import Reason
from tms_reason.reasons import (
    CorrectThere,
    ElementsTooDeep,
    ExportFromGroot,
    HasDoctype,
    ManyAttributes,
    ManyTags,
    NotUnicodeCharacter,
    NotWellFormed,
    NulByte,
    RemoveThem,
    RightFile,
    SaveAsUtf8,
    SaveFromGroot,
    SplitTask,
    TaskEmpty,
    TaskTooLarge,
    TemplateInclude,
    TemplateNodes,
    TemplateOuter,
    TemplateTrees,
    TemplateVersion,
    TextNotUtf8,
    WordTooLong,
    XmlHint,
    XmlLine,
)

MAX_BYTES = 5_000_000
MAX_TAGS = 200_000  # "<" in the text; bounds the memory that the parser takes
MAX_DEPTH = 200  # trees drawn by people have a tenth of it
MAX_EQUALS = 5000  # "=" in one tag; the parser compares attribute names pairwise

CALL = "ExecuteSubtask"  # an action that calls a template
OPEN_KEY = re.compile(r"\$(\w+)\$", re.ASCII)  # what a call of a template gives a value to

_PROLOG = re.compile(r"\s+|<\?.*?\?>|<!--.*?-->", re.DOTALL)
_DECLARATION = re.compile(r"<\?xml\s.*?\?>", re.DOTALL)


class XmlRefused(TaskError):
    """The text is not XML, or not XML that a task may be."""

    def __init__(self, what: Reason, line: int | None = None, hint: Reason | None = None) -> None:
        hinted = what if hint is None else XmlHint(what, hint)
        super().__init__(XmlLine(line, hinted) if line else hinted, self.code)
        self.what, self.line, self.hint = what, line, hint


def decode(data: bytes | str, limit: int = MAX_BYTES) -> str:
    """Text with plain line feeds; bytes are UTF-8 whatever the XML declaration says.

    Raises:
        XmlRefused: it is too large, empty or no text.
    """
    if len(data) > limit:
        raise XmlRefused(TaskTooLarge(limit), hint=RightFile())
    if isinstance(data, bytes):
        raw = data
        try:
            data = raw.decode("utf-8-sig")
        except UnicodeDecodeError as error:
            line = raw.count(b"\n", 0, error.start) + 1
            raise XmlRefused(TextNotUtf8(), line, SaveAsUtf8()) from error
    text = data.removeprefix("\ufeff").replace("\r\n", "\n").replace("\r", "\n")
    zero = text.find("\0")
    if zero >= 0:
        raise XmlRefused(NulByte(), _line(text, zero), SaveFromGroot())
    if not text.strip():
        raise XmlRefused(TaskEmpty(), hint=ExportFromGroot())
    return text


def elements(text: str, comments: bool) -> etree._Element:
    """The outermost element of a decoded text, with or without comments and processing instructions.

    Raises:
        XmlRefused: names the line.
    """
    _refuse_dtd(text)
    if text.count("<") > MAX_TAGS:
        raise XmlRefused(ManyTags(MAX_TAGS))
    if max(tag.count("=") for tag in text.split("<")) > MAX_EQUALS:
        raise XmlRefused(ManyAttributes())
    declaration = _DECLARATION.match(text)
    if declaration is not None:  # the parser would follow its encoding; keep the lines
        text = "\n" * declaration[0].count("\n") + text[declaration.end() :]
    try:
        root = etree.fromstring(text.encode(), _parser(comments))
    except UnicodeEncodeError as error:
        raise XmlRefused(NotUnicodeCharacter(), _line(text, error.start), SaveAsUtf8()) from error
    except etree.XMLSyntaxError as error:
        raise _refusal(error) from error
    _check_depth(root)
    return root


def template_top(root: etree._Element) -> etree._Element:
    """The node at the top of a template's only tree: what its callers get in the place of their call.

    Raises:
        XmlRefused: it has not the form of a template; with the line.
    """
    if root.tag != "root":
        raise XmlRefused(TemplateOuter(str(root.tag)), _line_of(root))
    if str(root.get("BTCPP_format", "")).strip().startswith("4"):
        raise XmlRefused(TemplateVersion(), _line_of(root))
    if (include := root.find("include")) is not None:
        raise XmlRefused(TemplateInclude(), _line_of(include))
    trees = root.findall("BehaviorTree")
    if len(trees) != 1:
        raise XmlRefused(TemplateTrees(len(trees)), _line_of(root))
    nodes = [child for child in trees[0] if isinstance(child.tag, str)]
    if len(nodes) != 1:
        raise XmlRefused(TemplateNodes(len(nodes)), _line_of(trees[0]))
    return nodes[0]


def is_call(element: etree._Element) -> bool:
    """Whether an element calls a template."""
    return element.tag == CALL or (element.tag == "Action" and element.get("ID") == CALL)


def _line_of(element: etree._Element) -> int:
    line: object = element.sourceline
    return line if isinstance(line, int) else 1


def _parser(comments: bool) -> etree.XMLParser:
    return etree.XMLParser(
        encoding="utf-8", resolve_entities=False, load_dtd=False, no_network=True, huge_tree=False,
        remove_comments=not comments, remove_pis=not comments,
    )  # fmt: skip


def _refuse_dtd(text: str) -> None:
    """Refuse a DTD, which can stand only before the root element: its entities must not reach the parser."""
    position = 0
    while (found := _PROLOG.match(text, position)) is not None:
        position = found.end()
    if text.startswith("<!DOCTYPE", position):
        raise XmlRefused(HasDoctype(), _line(text, position), RemoveThem())


def _refusal(error: etree.XMLSyntaxError) -> XmlRefused:
    said = " ".join(str(error.msg or "malformed").split(", line ")[0].split())
    line = error.lineno or 1
    if "depth" in said:  # libxml2's own limit lies a little above ours
        return _too_deep(line)
    if "XML_PARSE_HUGE" in said:
        return XmlRefused(WordTooLong(), line)
    return XmlRefused(NotWellFormed(said), line, CorrectThere())


def _check_depth(root: etree._Element) -> None:
    depth = 0
    for event, element in etree.iterwalk(root, events=("start", "end")):
        depth += 1 if event == "start" else -1
        if depth > MAX_DEPTH:
            raise _too_deep(_line_of(element))


def _too_deep(line: int) -> XmlRefused:
    return XmlRefused(ElementsTooDeep(MAX_DEPTH), line, SplitTask())


def _line(text: str, position: int) -> int:
    return text.count("\n", 0, position) + 1
