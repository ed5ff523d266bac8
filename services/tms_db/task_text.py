"""Checks a task's XML text before it is stored, finds what tells it apart, and its main machine model."""

import re
from collections import Counter
from collections.abc import Collection
from pathlib import Path

from lxml import etree

from tms_core.errors import TaskError

MAX_BYTES = 5 * 2**20
MAX_DEPTH = 200  # a tree that people drew is a tenth as deep
NO_DESCRIPTION = "No Commented."  # the paper's word; the C++ system's readers show it

# Words that the field's trees use, known even where a site has none of these machines.
MODELS = ("zx200", "zx120", "ic120", "mst110cr", "mst2200", "d37pxi")


def read_file(path: Path) -> str:
    """Text of a task file.

    Raises:
        TaskError: it cannot be read, is too big or is not UTF-8.
    """
    try:
        if path.stat().st_size > MAX_BYTES:
            raise TaskError(f"{path}: {_too_big(path.stat().st_size)}")
        return path.read_bytes().decode("utf-8")
    except OSError as error:
        raise TaskError(f"{path}: cannot be read ({error.strerror}): check the name") from error
    except UnicodeDecodeError as error:
        raise TaskError(f"{path}: is not UTF-8 text (byte {error.start}): save it as UTF-8") from error


def essence(text: str) -> str:
    """The checked text without the layout between tags: what tells two tasks apart, and how the C++ system stores it.

    Raises:
        TaskError: it is no task; says what, at which line, and what to do.
    """
    root = _parse(text)
    _check_depth(root)
    if root.tag != "root":
        raise TaskError(f"line {root.sourceline}: the outermost element is <{root.tag}>, not <root>: {_EXPORT}")
    if not any(tree.get("ID") or len(tree) for tree in root.iterchildren("BehaviorTree")):
        raise TaskError(f"line {root.sourceline}: there is no <BehaviorTree> with nodes in <root>: {_EXPORT}")
    for element in root.iter():
        if not (element.text or "").strip():
            element.text = None
        if not (element.tail or "").strip():
            element.tail = None
    return etree.tostring(root, encoding="unicode", with_tail=False)


def main_model(text: str, models: Collection[str]) -> str:
    """The model word that is most frequent in the text, the first one of equals; "" if there is none."""
    longest_first = sorted(models, key=len, reverse=True)
    if not longest_first:
        return ""
    found = Counter(re.findall("|".join(map(re.escape, longest_first)), text))
    return found.most_common(1)[0][0] if found else ""  # most_common keeps first-seen order among equals


_EXPORT = "export the task from Groot (Save tree) and register that file"


def _too_big(size: int) -> str:
    return f"is {size / 2**20:.1f} MB, a task may have {MAX_BYTES // 2**20} MB: is this the right file?"


def _parse(text: str) -> etree._Element:
    if not text.strip():
        raise TaskError(f"the task is empty: {_EXPORT}")
    try:
        data = text.lstrip("\ufeff").encode("utf-8")
    except UnicodeEncodeError as error:
        raise TaskError(f"character {error.start} is no valid Unicode: save the task as UTF-8") from error
    if len(data) > MAX_BYTES:
        raise TaskError(f"the task {_too_big(len(data))}")
    _refuse_doctype(text)
    # The text is decoded already, so what its declaration says about the encoding no longer holds.
    parser = etree.XMLParser(encoding="utf-8", resolve_entities=False, load_dtd=False, no_network=True, huge_tree=False)
    try:
        return etree.fromstring(data, parser)
    except etree.XMLSyntaxError as error:
        if "depth" in str(error):  # libxml2's own limit lies a little above ours
            raise TaskError(f"line {error.lineno}: {_TOO_DEEP}") from error
        what = " ".join((error.msg or "unknown error").split(", line ")[0].split())
        raise TaskError(f"line {error.lineno}: not well-formed XML ({what}): correct it there") from error


_TOO_DEEP = f"elements are nested more than {MAX_DEPTH} deep: split the task into subtrees"


def _refuse_doctype(text: str) -> None:
    """A DOCTYPE can stand before the root element only; nothing of it (entities!) may reach the parser."""
    at = 0
    while True:
        while at < len(text) and (text[at].isspace() or text[at] == "\ufeff"):
            at += 1
        end = {"<?": "?>", "<!--": "-->"}.get("<!--" if text.startswith("<!--", at) else text[at : at + 2])
        if end is None:
            break
        close = text.find(end, at + 2)
        if close < 0:
            return  # not well-formed: the parser says so, with the line
        at = close + len(end)
    if text.startswith("<!DOCTYPE", at):
        line = text.count("\n", 0, at) + 1
        raise TaskError(f"line {line}: a task must not have a DOCTYPE or entities: remove them")


def _check_depth(root: etree._Element) -> None:
    depth = 0
    for event, element in etree.iterwalk(root, events=("start", "end")):
        depth += 1 if event == "start" else -1
        if depth > MAX_DEPTH:
            raise TaskError(f"line {element.sourceline}: {_TOO_DEEP}")
