"""The check of a template by itself: its form, its nodes and ports, what it calls, and the keys that it takes.

Values are not looked at, as only a call gives them.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import islice

from lxml import etree

from tms_reason import xml_text
from tms_reason.reason import Reason
from tms_reason.xml_text import OPEN_KEY
from tms_ts.bt.document import Document, read
from tms_ts.bt.errors import TreeError
from tms_ts.bt.expand import MAX_ERRORS, Templates, expand, filled
from tms_ts.bt.registry import registry
from tms_ts.bt.source import line_of
from tms_ts.bt.verify import Rules
from tms_ts.tree_reasons import TreeNameForCpp

TREE_OF_CPP = "BehaviorTree"  # the C++ system finds the nodes of a template by this name


@dataclass(slots=True)
class TemplateReport:
    """What was found."""

    keys: list[str] = field(default_factory=list)  # in the order of the text
    warnings: list[tuple[int, Reason]] = field(default_factory=list)
    errors: list[TreeError] = field(default_factory=list)


def check_template(name: str, text: str, templates: Templates | None, *, cpp: bool = False) -> TemplateReport:
    """Check a template's text; `templates` and `cpp` as for a task."""
    report = TemplateReport()
    try:
        document = read(text)
        top = xml_text.template_top(document.sources[0].root)
    except TreeError as error:
        report.errors.append(error)
        return report
    except xml_text.XmlRefused as refused:
        report.errors.append(TreeError(refused.what, line=refused.line))
        return report
    report.keys = _fill(top)
    expand(document, templates, cpp=cpp, inside=name)
    report.errors = list(islice(Rules(document, registry()).errors(), MAX_ERRORS))
    report.warnings = document.warnings
    if not _cpp_finds_it(document):
        report.warnings.append((line_of(document.sources[0].root), TreeNameForCpp()))
    return report


def _fill(top: etree._Element) -> list[str]:
    """Fill the template's own keys in as a call would, so that they are not errors; returns them."""
    keys: dict[str, None] = {}
    for node in top.iter("*"):
        for port, given in node.attrib.items():
            found = OPEN_KEY.findall(str(given))
            keys.update(dict.fromkeys(found))
            node.set(port, filled(str(given), {key: key for key in found}) or str(given))
    return list(keys)


def _cpp_finds_it(document: Document) -> bool:
    root, tree = document.sources[0].root, document.trees[0]
    known = root.get("main_tree_to_execute") == TREE_OF_CPP == tree.id
    return known and root.find("TreeNodesModel") is not None
