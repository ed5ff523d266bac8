"""Which machines a task moves, from its tree and the templates that it calls: asked before it is started."""

import re
from collections.abc import Callable, Iterable

from lxml import etree

CALL = "ExecuteSubtask"  # a node of version 6 that is replaced by the template of its subtask_name


def machines_of(xml: str, template: Callable[[str], str], names: Iterable[str]) -> list[str]:
    """The machines of the site that leaves name, in the site's order; all where a leaf gets its machine while it runs.

    `template` gives the text of a template by its name, and raises TmsError where there is none. Text that is no XML
    moves nothing: the check before the run refuses it.
    """
    found: set[str] = set()
    read: set[str] = set()
    texts = [xml]
    while texts:
        for element in _elements(texts.pop()):
            found.add(element.get("model_name", ""))
            called = element.get("subtask_name", "")
            if CALL in (element.tag, element.get("ID")) and called and called not in read:
                read.add(called)
                texts.append(template(called))
    late = any(re.search(r"[{$]", name) for name in found)
    return [name for name in names if late or name in found]


def _elements(xml: str) -> list[etree._Element]:
    parser = etree.XMLParser(resolve_entities=False, no_network=True, recover=True)
    try:
        root = etree.fromstring(xml.encode(), parser)
    except etree.XMLSyntaxError:
        return []
    return [] if root is None else [one for one in root.iter() if isinstance(one.tag, str)]
