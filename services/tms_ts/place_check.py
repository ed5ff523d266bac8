"""What is found before a run about the shared places that its tree holds. Pure logic."""

from collections.abc import Iterable, Mapping

from tms_config.config import Site
from tms_config.reasons import NoMachine
from tms_places.reasons import HoldsAndTakes, MayWaitInCircle, NoPlace
from tms_places.waits import Order, Step, crossing, orders
from tms_ts.bt import Tree
from tms_ts.bt.errors import within
from tms_ts.nodes.place_leaf import PlaceLeaf
from tms_ts.preflight import Findings, at

Orders = Mapping[str, set[Order]]  # of each machine


def leaves_of(tree: Tree) -> list[PlaceLeaf]:
    """The nodes that take or free a place."""
    return [node for node in tree.nodes if isinstance(node, PlaceLeaf)]


def orders_of(tree: Tree) -> Orders:
    """Which places each machine holds while it takes others, as far as the document tells."""
    steps = [Step(*leaf.place_asked(), leaf.holds) for leaf in leaves_of(tree)]
    return orders([step for step in steps if "{" not in step.machine + step.place])


def check_places(tree: Tree, site: Site, known: Iterable[str], others: Orders) -> Findings:
    """Errors for places and machines that are not there; warnings where machines may come to wait for each other.

    `others`: of the machines of other runs.
    """
    found, names = Findings(), tuple(known)
    for leaf in leaves_of(tree):
        machine, place = leaf.place_asked()
        if "{" not in place and place not in names:
            found.errors.append(at(leaf.line, within(leaf.template, NoPlace(place, names))))
        if "{" not in machine and machine not in site.file.machines:
            wrong = NoMachine(machine, tuple(site.file.machines))
            found.errors.append(at(leaf.line, within(leaf.template, wrong)))
    own = orders_of(tree)
    for circle in crossing({**others, **own}):
        if any(machine in own for machine, _, _ in circle):
            found.warnings.append(MayWaitInCircle(tuple(HoldsAndTakes(*one) for one in circle)))
    return found
