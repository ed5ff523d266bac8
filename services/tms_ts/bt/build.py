"""From a verified document to nodes, in document order, subtree content directly after its SubTree node."""

from __future__ import annotations

from lxml import etree

from tms_reason.xml_text import MAX_DEPTH
from tms_ts.bt.blackboard import Blackboard
from tms_ts.bt.context import Context
from tms_ts.bt.convert import Missing, text_to_bool
from tms_ts.bt.document import Document, TreeElement, children
from tms_ts.bt.errors import TreeError
from tms_ts.bt.node import Node, NodeSpec
from tms_ts.bt.ports import RESERVED, Direction, Pointer, bind
from tms_ts.bt.source import line_of
from tms_ts.bt.verify import Rules, Use
from tms_ts.tree_reasons import AdoptedLeaf, ManyNodes, NoTreeOfId, NotTrueOrFalse, TreeInItself, TreeTooDeep

MAX_NODES = 20_000


class Builder:
    """Makes the nodes of one tree from its document."""

    def __init__(self, document: Document, rules: Rules, context: Context[Node]) -> None:
        self.document = document
        self.rules = rules
        self.context = context
        self.trees = document.by_id()
        self.nodes: list[Node] = []  # pre-order
        self.blackboards: list[Blackboard] = []  # in creation order
        self.open_trees: list[str] = []

    def build(self, blackboard: Blackboard) -> Node:
        self.blackboards.append(blackboard)
        main = self.trees[self.document.main]
        root = self.tree(main, blackboard, "0", main.element)
        for node in self.nodes:
            self.mark_written(node)
        return root

    @staticmethod
    def mark_written(node: Node) -> None:
        """Mark the keys that are no constants: outputs, and keys whose names ports give as text, as Counter's does."""
        for port, bound in node.bindings.items():
            if isinstance(bound, str):
                node.blackboard.vary(bound)
            elif node.ports[port].direction is not Direction.INPUT:
                node.blackboard.vary(bound.key)

    def tree(self, tree: TreeElement, blackboard: Blackboard, path: str, caller: etree._Element) -> Node:
        if tree.id in self.open_trees:
            chain = " -> ".join([*self.open_trees[self.open_trees.index(tree.id) :], tree.id])
            raise TreeError(TreeInItself(tree.id, chain), line=line_of(caller), path=path)
        self.open_trees.append(tree.id)
        node = self.node(next(children(tree.element)), tree, blackboard, path)
        self.open_trees.pop()
        return node

    def node(self, element: etree._Element, tree: TreeElement, blackboard: Blackboard, path: str) -> Node:
        line = line_of(element)
        template = self.document.places.get(element, "")
        if len(self.nodes) >= MAX_NODES:
            raise TreeError(ManyNodes(MAX_NODES), line=line, path=path, template=template)
        if path.count(".") >= MAX_DEPTH:
            raise TreeError(TreeTooDeep(MAX_DEPTH), line=line, path=path, template=template)
        use = self.rules.use(element, tree)
        if use.subtree:
            return self.subtree(use, element, tree, blackboard, path)
        assert use.cls is not None  # verified
        bindings = {k: bind(k, v, v4=tree.v4) for k, v in use.attributes.items() if k not in RESERVED}
        name = use.attributes.get("name", use.id)
        spec = NodeSpec(use.id, name, self.context, blackboard, bindings, path, line, template=template)
        self.declare(use.cls, spec)
        node = use.cls(spec)
        if use.id in self.rules.adopted:
            node.warn(AdoptedLeaf(use.id))
        self.nodes.append(node)
        for position, child in enumerate(children(element)):
            self.attach(self.node(child, tree, blackboard, f"{path}.{position}"), node)
        return node

    @staticmethod
    def attach(child: Node, parent: Node) -> None:
        child.parent = parent
        parent.children.append(child)

    @staticmethod
    def declare(cls: type[Node], spec: NodeSpec) -> None:
        for port, bound in spec.bindings.items():
            if isinstance(bound, Pointer):
                try:
                    spec.blackboard.declare(bound.key, cls.ports[port].kind)
                except TreeError as error:
                    error.place(spec.line, spec.path, spec.template)
                    raise

    # --- subtrees

    def subtree(self, use: Use, element: etree._Element, tree: TreeElement, blackboard: Blackboard, path: str) -> Node:
        line, template = line_of(element), self.document.places.get(element, "")
        if use.id not in self.trees:
            raise TreeError(NoTreeOfId(use.id), line=line, path=path, template=template)
        cls = self.rules.registry[use.subtree]
        name = use.attributes.get("name", use.id) if tree.v4 else use.id
        node = cls(NodeSpec(use.subtree, name, self.context, blackboard, {}, path, line, template=template))
        self.nodes.append(node)
        try:
            inner = self.inner_blackboard(use, blackboard, v4=tree.v4)
        except TreeError as error:
            error.place(line, path, template)
            raise
        self.attach(self.tree(self.trees[use.id], inner, f"{path}.0", element), node)
        return node

    def inner_blackboard(self, use: Use, outer: Blackboard, *, v4: bool) -> Blackboard:
        if use.subtree == "SubTree" and self.flag(use, "__shared_blackboard"):
            return outer
        inner = Blackboard(outer)
        self.blackboards.append(inner)
        for key, value in use.attributes.items():
            if key in RESERVED or key == "__shared_blackboard":
                continue
            if use.subtree == "SubTree":
                if key != "__autoremap":
                    inner.remap(key, value)
            elif key == "__autoremap":
                if self.flag(use, key):
                    inner.remap_all(but_private=v4)
            elif isinstance(bound := bind(key, value, v4=v4), Pointer) and bound.text != "=":
                inner.remap(key, bound.key)
            else:  # set once, at loading; after __autoremap it goes to the outer blackboard, as in the library
                inner.set(key, value)
        return inner

    @staticmethod
    def flag(use: Use, key: str) -> bool:
        value = text_to_bool(use.attributes.get(key, "false"))
        if isinstance(value, Missing):
            raise TreeError(NotTrueOrFalse(key, use.attributes[key]))
        return value
