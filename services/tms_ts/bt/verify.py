"""The loading rules of the library, applied to every tree of a document; no node is made or run here."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from lxml import etree

from tms_reason.reason import Reason
from tms_ts.bt import v4
from tms_ts.bt.convert import MISSING
from tms_ts.bt.document import Document, TreeElement, children
from tms_ts.bt.errors import TreeError, did_you_mean
from tms_ts.bt.node import Node
from tms_ts.bt.ports import RESERVED
from tms_ts.bt.registry import Registry
from tms_ts.bt.source import line_of
from tms_ts.bt.status import NodeType
from tms_ts.tree_reasons import (
    AddThirdChild,
    InSubTreePlus,
    ItsPorts,
    LeafWithChildren,
    NeedsChildren,
    NeedsId,
    NoNode,
    NoPort,
    NoPorts,
    NoTerminal,
    NoTreeOfId,
    NotUsed,
    OldSpelling,
    OneChildInDecorator,
    OneChildInTree,
    OnlyV3,
    PortMissing,
    SubTreeWithChildren,
    There,
    ThereIsNoTree,
    ThreeChildrenInV4,
    TreeNotNode,
    UnknownMainTree,
    WriteSubTree,
)

CATEGORIES = frozenset({"Action", "Condition", "Control", "Decorator"})
SUBTREES = frozenset({"SubTree", "SubTreePlus"})
Problem = tuple[Reason, "Reason | None"]  # what is wrong, and a hint
NEED_CHILDREN = frozenset({"Sequence", "SequenceStar", "Fallback"})
HINTS: dict[str, Reason] = {
    "ManualSelector": NoTerminal(),
    "RetryUntilSuccesful": OldSpelling("RetryUntilSuccessful"),
}


class Use(NamedTuple):
    """What one element asks for."""

    tag: str  # as written
    id: str  # registration ID, or tree ID of a subtree
    attributes: dict[str, str]
    cls: type[Node] | None
    subtree: str  # SubTree or SubTreePlus; empty for other nodes


class Rules:
    """Which class an element means, and what is wrong with it."""

    def __init__(self, document: Document, registry: Registry) -> None:
        self.document = document
        self.registry = registry
        self.tree_ids = frozenset(document.by_id())
        self.adopted: dict[str, type[Node] | None] = {}
        self._uses: dict[etree._Element, Use] = {}

    def use(self, element: etree._Element, tree: TreeElement) -> Use:
        """What an element means; found once, as it is asked for by the checks and when the nodes are made."""
        if (found := self._uses.get(element)) is None:
            found = self._uses[element] = self._use(element, tree)
        return found

    def _use(self, element: etree._Element, tree: TreeElement) -> Use:
        attributes = tree.source.attributes(element)
        tag = str(element.tag)
        name = tag
        if tree.v4:
            name, attributes = v4.translated(tag, attributes)
        if name in SUBTREES:
            return Use(tag, attributes.get("ID", ""), attributes, None, name)
        if name in CATEGORIES:
            name = attributes.get("ID", "")
            if tree.v4:
                name, attributes = v4.translated(name, attributes)
        if name not in self.registry and name in self.tree_ids and tag in CATEGORIES:
            return Use(tag, attributes.get("name", name), attributes, None, "SubTree")
        return Use(tag, name, attributes, self.class_of(name), "")

    def class_of(self, name: str) -> type[Node] | None:
        cls = self.registry.get(name)
        if cls is None and name in self.document.models:
            if name not in self.adopted:
                self.adopted[name] = self.registry.generic_for(name, self.document.models[name])
            cls = self.adopted[name]
        return None if cls is not None and cls.kind is NodeType.SUBTREE else cls

    # --- checks

    def errors(self) -> Iterator[TreeError]:
        """Every broken rule, in document order.

        As in the library, a tree that the main tree does not use must be well formed, but its nodes need not be known.
        """
        yield from self.document.errors
        used = self.used_trees()
        for tree in self.document.trees:
            count = sum(1 for _ in children(tree.element))
            if count != 1:
                yield self.error(tree, tree.element, OneChildInTree(count))
            for child in children(tree.element):
                yield from self.tree_errors(tree, child, used=id(tree) in used)
        try:
            main = self.document.main
        except TreeError as error:
            yield error
            return
        if main not in self.tree_ids:
            others = There(tuple(sorted(self.tree_ids))) if self.tree_ids else ThereIsNoTree()
            hint = did_you_mean(main, self.tree_ids) or others
            yield TreeError(UnknownMainTree(main), line=1, hint=hint)

    def tree_errors(self, tree: TreeElement, top: etree._Element, *, used: bool) -> Iterator[TreeError]:
        for element in top.iter("*"):
            use = self.use(element, tree)
            count = sum(1 for _ in children(element))
            broken = self.broken_form(use, count, tree)
            if not broken and not self.document.warns and (not used or ignored(element)):
                continue  # the search for near names takes long and is left out for errors that are not shown
            problem = broken or self.cannot_be_made(use, count, tree)
            if problem is None:
                continue
            inside = ignored(element)
            if broken or (used and not inside):
                yield self.error(tree, element, *problem)
            else:
                why = problem[0]
                self.document.warn_at(element, InSubTreePlus(why) if inside else NotUsed(tree.id, why))

    def used_trees(self) -> set[int]:
        """The `id` of the trees that the main tree leads to; of all trees if there is no main tree."""
        trees = self.document.by_id()
        try:
            open_ids = [self.document.main]
        except TreeError:
            open_ids = []
        if not open_ids or open_ids[0] not in trees:
            return {id(tree) for tree in self.document.trees}
        found: set[int] = set()
        while open_ids:
            tree = trees.get(open_ids.pop())
            if tree is None or id(tree) in found:
                continue
            found.add(id(tree))
            uses = (self.use(element, tree) for element in tree.element.iter(*SUBTREES, *CATEGORIES))
            open_ids.extend(use.id for use in uses if use.subtree)
        return found

    def error(self, tree: TreeElement, element: etree._Element, what: Reason, hint: Reason | None = None) -> TreeError:
        names = [str(element.tag)] + [str(above.tag) for above in element.iterancestors()]
        path = "/".join([tree.id, *reversed(names[: max(len(names) - 2, 0)])])
        template = self.document.places.get(element, "")
        return TreeError(what, line=line_of(element), path=path, hint=hint, file=tree.source.file, template=template)

    def broken_form(self, use: Use, count: int, tree: TreeElement) -> Problem | None:
        """The error that the library finds in every tree of a document, also in an unused one."""
        if not use.id:
            return NeedsId(use.tag), None
        if use.subtree:
            return (SubTreeWithChildren(), None) if count and use.subtree == "SubTree" else None
        if use.cls is not None:
            return self.children_problem(use, use.cls, count)
        return None if use.tag in CATEGORIES else self.v4_feature(use, tree) or self.unknown(use)

    def cannot_be_made(self, use: Use, count: int, tree: TreeElement) -> Problem | None:
        """The error that the library finds when it makes the nodes."""
        feature = self.v4_feature(use, tree)
        if feature:
            return feature
        if tree.v4 and use.id == "WhileDoElse" and count == 2:
            return ThreeChildrenInV4(), AddThirdChild()
        if use.subtree:
            known = use.id in self.tree_ids
            return None if known else (NoTreeOfId(use.id), did_you_mean(use.id, self.tree_ids))
        return self.unknown(use) if use.cls is None else self.port_problem(use, use.cls)

    @staticmethod
    def v4_feature(use: Use, tree: TreeElement) -> Problem | None:
        feature = v4.feature(use.tag if use.tag not in CATEGORIES else use.id, use.attributes, v4=tree.v4)
        return None if feature is None else (feature, OnlyV3())

    def unknown(self, use: Use) -> Problem:
        if use.id in self.tree_ids:
            return TreeNotNode(use.tag), WriteSubTree(use.id)
        hint = HINTS.get(use.id) or did_you_mean(use.id, [*self.registry, *CATEGORIES, *SUBTREES])
        return NoNode(use.id), hint

    @staticmethod
    def children_problem(use: Use, cls: type[Node], count: int) -> Problem | None:
        if (use.tag == "Decorator" or cls.kind is NodeType.DECORATOR) and count != 1:
            return OneChildInDecorator(use.id, count), None
        leaf = cls.kind in (NodeType.ACTION, NodeType.CONDITION)
        if count and (leaf or use.tag in ("Action", "Condition")):
            return LeafWithChildren(use.id), None
        if not count and (use.tag == "Control" or use.tag in NEED_CHILDREN):
            return NeedsChildren(use.id), None
        return None

    @staticmethod
    def port_problem(use: Use, cls: type[Node]) -> Problem | None:
        for key in use.attributes:
            if key not in RESERVED and key not in cls.ports:
                ports = ItsPorts(tuple(cls.ports)) if cls.ports else NoPorts()
                return NoPort(use.id, key), did_you_mean(key, cls.ports) or ports
        if cls.required.issubset(use.attributes):
            return None
        for port in sorted(cls.required):
            if port not in use.attributes and cls.ports[port].default is MISSING:
                return PortMissing(use.id, port), None
        return None


def ignored(element: etree._Element) -> bool:
    """Whether the library ignores an element."""
    return any(above.tag == "SubTreePlus" for above in element.iterancestors())
