"""Checks a task's XML text before it is stored, and finds its essence and its main machine model."""

import re
from collections import Counter
from collections.abc import Collection
from functools import cache
from pathlib import Path

from lxml import etree

from tms_db.reasons import FileNotUtf8, NoTreeInRoot, OuterElement, TaskFileLarge, UnreadableFile
from tms_reason import xml_text
from tms_reason.errors import TaskError

NO_DESCRIPTION = "No Commented."  # the paper's word; the C++ system's readers show it

# Words that the field's trees use, known even where a site has none of these machines.
MODELS = ("zx200", "zx120", "ic120", "mst110cr", "mst2200", "d37pxi")


def read_file(path: Path) -> str:
    """Text of a task file.

    Raises:
        TaskError: it cannot be read, is too big or is not UTF-8.
    """
    try:
        if path.stat().st_size > xml_text.MAX_BYTES:
            size = path.stat().st_size / 2**20
            raise TaskError(TaskFileLarge(str(path), size, xml_text.MAX_BYTES), TaskError.code)
        return path.read_bytes().decode("utf-8")
    except OSError as error:
        raise TaskError(UnreadableFile(str(path), str(error.strerror)), TaskError.code) from error
    except UnicodeDecodeError as error:
        raise TaskError(FileNotUtf8(str(path), error.start), TaskError.code) from error


def essence(text: str) -> str:
    """The checked text without the layout between tags: it identifies a task, and the C++ system stores it so.

    Raises:
        TaskError: it is no task; says what, at which line, and what to do.
    """
    root = xml_text.elements(xml_text.decode(text), comments=True)
    if root.tag != "root":
        raise TaskError(OuterElement(_line(root), str(root.tag)), TaskError.code)
    if not any(tree.get("ID") or len(tree) for tree in root.iterchildren("BehaviorTree")):
        raise TaskError(NoTreeInRoot(_line(root)), TaskError.code)
    for element in root.iter():
        if not (element.text or "").strip():
            element.text = None
        if not (element.tail or "").strip():
            element.tail = None
    return etree.tostring(root, encoding="unicode", with_tail=False)


def main_model(text: str, models: Collection[str]) -> str:
    """The model word that is most frequent in the text, the first one of equals; "" if there is none."""
    if not models:
        return ""
    found = Counter(_any_of(frozenset(models)).findall(text))
    return found.most_common(1)[0][0] if found else ""  # most_common keeps first-seen order among equals


@cache
def _any_of(words: frozenset[str]) -> re.Pattern[str]:
    return re.compile("|".join(map(re.escape, sorted(words, key=len, reverse=True))))


def _line(element: etree._Element) -> int:
    line: object = element.sourceline
    return line if isinstance(line, int) else 0
