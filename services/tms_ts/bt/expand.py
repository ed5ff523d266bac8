"""Calls of templates: in the place of each ExecuteSubtask comes the tree of its template, before the rules are applied.

These are the rules of the C++ system, which works on the text of the task:

- `<Action ID="ExecuteSubtask" subtask_name="Dig" subtask_parameters="a:pose_1,b:pose_2" .../>` calls the template Dig.
- `subtask_parameters` is cut at each comma, and each part at its first colon; blanks count, a part without a colon
  does not. These keys, and before them the other attributes of the call (not ID and subtask_name), have values.
- In every attribute of the template `$key$` becomes the value of the key: all of the first key in alphabetical order,
  then all of the next, so that a value may hold a `$key$` of a later one.
- There is no blackboard of its own: a template uses the keys of the tree that calls it.

Other than there, a `$key$` without a value is an error (there it becomes the word none), and so is a template that
nobody has (there the call goes); templates may call templates (there such a tree does not load).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from copy import deepcopy
from dataclasses import dataclass

from lxml import etree

from tms_reason import xml_text
from tms_reason.reason import Reason
from tms_reason.xml_text import CALL, OPEN_KEY, is_call
from tms_ts.bt.document import Document, TreeElement, check_depth, children, described
from tms_ts.bt.errors import TreeError
from tms_ts.bt.source import ParsedXml, line_of, parse, set_line, settled
from tms_ts.tree_reasons import (
    CallInV4,
    CallNotSeen,
    CallWithChildren,
    CallWithSlash,
    KeyBecomesNone,
    KeyOpen,
    KeysGiven,
    NestedCall,
    NoKeysGiven,
    NoTemplate,
    NoTemplateName,
    PartWithoutColon,
    TemplateInItself,
    TemplatesLarge,
    TemplatesNested,
    TemplateUnseen,
    TemplateUnusable,
    ValueTooLong,
)

NO_KEYS = frozenset({"ID", "subtask_name", "subtask_parameters"})
MAX_CHAIN = 50  # templates that call each other
MAX_NODES = 20_000  # of all templates of a task
MAX_VALUE = 100_000  # letters of an attribute after the keys are filled in
MAX_ERRORS = 100  # more are no help to the author

Templates = Callable[[str], "str | None"]  # a template's text by its name; None: there is none


def no_templates(_name: str) -> None:
    """Know no template."""


def expand(document: Document, templates: Templates | None, *, cpp: bool = False, inside: str = "") -> None:
    """Put templates in the place of their calls. What is wrong with a call goes to the errors of the document.

    templates: None where they cannot be asked for; the calls are then left out, with a warning. For checks only!
    cpp: a key without a value becomes the word none, as in the C++ system, with a warning
    inside: name of the template that the document is
    """
    calls = [(tree, call) for tree in document.trees for call in tree.element.iter("*") if is_call(call)]
    if not calls:
        return
    plain = {id(tree.source): settled(tree.source) for tree, _ in calls}
    for tree in document.trees:
        tree.source = plain.get(id(tree.source), tree.source)
    expansion = _Expansion(document, templates, cpp)
    for tree, call in calls:
        expansion.call(call, tree, (inside,) if inside else ())
    for source in plain.values():
        check_depth(source)


def given_values(attributes: Mapping[str, str]) -> dict[str, str]:
    """The values that a call gives to the keys of its template."""
    values = dict(attributes)
    for part in attributes.get("subtask_parameters", "").split(","):
        key, colon, value = part.partition(":")
        if colon:
            values[key] = value
    return {key: value for key, value in values.items() if key not in NO_KEYS}


def filled(text: str, values: Mapping[str, str]) -> str | None:
    """A text with its keys filled in; None if it gets too long."""
    for key in sorted(values):
        mark, value = f"${key}$", values[key]
        if len(text) + text.count(mark) * (len(value) - len(mark)) > MAX_VALUE:
            return None
        text = text.replace(mark, value)
    return text


@dataclass(frozen=True, slots=True)
class _Template:
    top: etree._Element
    source: ParsedXml


class _Expansion:
    """The calls of one document."""

    def __init__(self, document: Document, templates: Templates | None, cpp: bool) -> None:
        self.document, self.cpp = document, cpp
        self.templates = templates
        self.read: dict[str, _Template | Reason] = {}  # or why it cannot be used
        self.nodes = 0

    def call(self, element: etree._Element, tree: TreeElement, chain: tuple[str, ...]) -> None:
        """Put a template in the place of a call; `chain`: the templates that the call itself stands in."""
        call = tree.source.attributes(element)
        name = call.get("subtask_name", "")
        if len(self.document.errors) >= MAX_ERRORS:
            return
        self.advise(element, call, chain)
        found = self.refused(element, tree, name, chain) or self.template(name)
        if isinstance(found, _Template):
            self.nodes += sum(1 for _ in found.top.iter("*"))
            found = TemplatesLarge(MAX_NODES) if self.nodes > MAX_NODES else found
        if isinstance(found, _Template):
            self.insert(element, tree, found, given_values(call), (*chain, name))
            return
        if isinstance(found, TemplateUnseen):
            self.document.warn_at(element, found)
        else:
            self.wrong(element, tree, found)
        _replace(element, etree.Element("AlwaysSuccess"))  # so that nothing else is found wrong with it

    def refused(self, element: etree._Element, tree: TreeElement, name: str, chain: tuple[str, ...]) -> Reason | None:
        """Why a call is none, whatever its template is."""
        if tree.v4:
            return CallInV4()
        if not name:
            return NoTemplateName()
        if next(children(element), None) is not None:
            return CallWithChildren()
        if name in chain:
            return TemplateInItself(name, " -> ".join([*chain[chain.index(name) :], name]))
        return TemplatesNested(MAX_CHAIN) if len(chain) >= MAX_CHAIN else None

    def advise(self, element: etree._Element, call: Mapping[str, str], chain: tuple[str, ...]) -> None:
        """Warn where the C++ system does something else."""
        if chain:
            self.document.warn_at(element, NestedCall(call.get("subtask_name", "")))
        elif element.tag == CALL or next(iter(call)) != "ID":
            self.document.warn_at(element, CallNotSeen())
        elif (slashed := next((port for port, value in call.items() if "/" in value), None)) is not None:
            self.document.warn_at(element, CallWithSlash(slashed, call[slashed]))
        for part in call.get("subtask_parameters", "").split(","):
            if part.strip() and ":" not in part:
                self.document.warn_at(element, PartWithoutColon(part))

    def template(self, name: str) -> _Template | Reason:
        if self.templates is None:
            return TemplateUnseen(name)
        if name not in self.read:
            text = self.templates(name)
            if text is None:
                self.read[name] = NoTemplate(name)
            else:
                self.document.templates[name] = text
                self.read[name] = self.parsed(name, text)
        return self.read[name]

    def parsed(self, name: str, text: str) -> _Template | Reason:
        try:
            source = settled(parse(text))
            top = xml_text.template_top(source.root)
        except (TreeError, xml_text.XmlRefused) as error:
            return TemplateUnusable(name, error.reason)
        for node, ports in described(source.root.iterfind("TreeNodesModel/*")):
            self.document.models.setdefault(node, ports)
        return _Template(top, source)

    def insert(
        self, element: etree._Element, tree: TreeElement, template: _Template, values: Mapping[str, str],
        chain: tuple[str, ...],
    ) -> None:  # fmt: skip
        copy, places = deepcopy(template.top), self.document.places
        outer, line = places.get(element, ""), line_of(element)
        calls = []
        for original, node in zip(template.top.iter("*"), copy.iter("*"), strict=True):
            places[node] = f"{outer} > {chain[-1]}:{line_of(original)}".removeprefix(" > ")
            set_line(node, line)
            self.fill(node, tree, values)
            calls += [node] if is_call(node) else []
        _replace(element, copy)
        for call in calls:
            self.call(call, tree, chain)

    def fill(self, node: etree._Element, tree: TreeElement, values: Mapping[str, str]) -> None:
        """Fill the keys of one element in."""
        for port, written in node.attrib.items():
            if "$" not in written:
                continue
            text = filled(str(written), values)
            if text is None:
                self.wrong(node, tree, ValueTooLong(str(port), MAX_VALUE))
                continue
            for key in dict.fromkeys(OPEN_KEY.findall(text)):
                if self.cpp:
                    self.document.warn_at(node, KeyBecomesNone(key))
                else:
                    given = tuple(f"${one}$" for one in values)
                    self.wrong(node, tree, KeyOpen(key), KeysGiven(given, key) if given else NoKeysGiven(key))
            node.set(port, OPEN_KEY.sub("none", text) if self.cpp else text)

    def wrong(self, node: etree._Element, tree: TreeElement, what: Reason, hint: Reason | None = None) -> None:
        place = self.document.places.get(node, "")
        self.document.errors.append(
            TreeError(what, line=line_of(node), hint=hint, file=tree.source.file, template=place)
        )


def _replace(element: etree._Element, new: etree._Element) -> None:
    set_line(new, line_of(element))
    parent = element.getparent()
    assert parent is not None  # it stands in a <BehaviorTree>
    parent.replace(element, new)
