"""A tree as py_trees shows trees: as text, as a dot graph, and to its visitors.

Every node gets a twin of the nearest class of py_trees, because the displays choose symbols and shapes by class. The
twins hold names and statuses of one moment and are never ticked.
"""

from __future__ import annotations

import uuid
from collections.abc import Callable

import py_trees.display
from py_trees.behaviour import Behaviour
from py_trees.common import ParallelPolicy
from py_trees.common import Status as PyTreesStatus
from py_trees.composites import Parallel as PyTreesParallel
from py_trees.composites import Selector
from py_trees.composites import Sequence as PyTreesSequence
from py_trees.decorators import Decorator as PyTreesDecorator

from tms_reason.texts import text
from tms_ts.bt.control import InOrder
from tms_ts.bt.errors import short
from tms_ts.bt.node import Node
from tms_ts.bt.parallel import Parallel
from tms_ts.bt.reactive import Reactive
from tms_ts.bt.status import PY_TREES, SUCCESS, NodeType
from tms_ts.bt.tree import Tree

LONGEST = 80  # letters of a port's text


class Twin(Behaviour):
    """The twin of a leaf, and of a control node to which no class of py_trees corresponds."""

    def update(self) -> PyTreesStatus:
        """Never called in a display."""
        return self.status


class ShownDecorator(PyTreesDecorator):
    """The twin of a decorator or subtree."""

    def update(self) -> PyTreesStatus:
        """Never called in a display."""
        return self.status


class Thresholds(ParallelPolicy.Base):
    """The policy of a Parallel; its ports have the numbers."""


def ascii_tree(tree: Tree, *, status: bool = False) -> str:
    """One line a node, indented; `status`: with status and reason."""
    return py_trees.display.ascii_tree(twin(tree.root), show_status=status)


def dot(tree: Tree) -> str:
    """A graph for Graphviz."""
    graph = py_trees.display.dot_tree(twin(tree.root, lambda node: node.path))
    labels = {node.path: label(node).replace("\\", "\\\\") for node in tree.nodes}
    for shown in graph.get_nodes():
        path = str(shown.get_name()).strip('"')
        if path in labels:  # all other nodes are defaults of the graph
            symbol = str(shown.get("label")).strip('"').partition(path)[0]  # the symbol of a node with memory
            shown.set("label", symbol + labels[path])
    return str(graph.to_string())


def twin(node: Node, named: Callable[[Node], str] | None = None) -> Behaviour:
    """A node and everything below it in classes of py_trees, with their present statuses."""
    name = (named or label)(node)
    made = _bare(node, name, [twin(child, named) for child in node.children])
    made.id = uuid.UUID(int=node.uid)  # the same in every twin of the node, for visitors that compare
    made.status = PY_TREES[node.state]
    made.feedback_message = "" if node.reason is None else text(node.reason, "en")
    return made


def _bare(node: Node, name: str, children: list[Behaviour]) -> Behaviour:
    if isinstance(node, InOrder | Reactive):
        kind = PyTreesSequence if node.goes_on is SUCCESS else Selector
        return kind(name, memory=isinstance(node, InOrder), children=children)
    if isinstance(node, Parallel):
        return PyTreesParallel(name, Thresholds(), children)
    if node.kind in (NodeType.DECORATOR, NodeType.SUBTREE):
        return ShownDecorator(name, children[0])
    made = Twin(name)
    for child in children:
        child.parent = made
    made.children = children
    return made


def label(node: Node) -> str:
    """Name, type where it is another word, and the ports as the document gives them."""
    title = node.name if node.name == node.registration_name else f"{node.name} ({node.registration_name})"
    ports = [f'{port}="{short(given, LONGEST)}"' for port, given in node.assigned().items()]
    return "\n".join(filter(None, [title, " ".join(ports)]))
