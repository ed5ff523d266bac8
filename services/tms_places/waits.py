"""Who waits for whom: among machines that wait now, and among those that may come to wait."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from tms_places.claims import Book


@dataclass(frozen=True)
class Step:
    """One node of a tree that takes or frees a place, in the order of the document."""

    machine: str
    place: str
    hold: bool


Order = tuple[str, str]  # a place that is held while the other one is taken


def waiting_for(book: Book) -> dict[str, set[str]]:
    """Machines, and those for which each waits: holders of what it wants, and who came first for the same."""
    found: dict[str, set[str]] = {}
    for number, one in enumerate(book.queue):
        missing = set(one.places) - book.held(one.machine).keys()
        ahead = {book.claims[place].machine for place in missing & book.claims.keys()}
        ahead |= {before.machine for before in book.queue[:number] if not missing.isdisjoint(before.places)}
        found.setdefault(one.machine, set()).update(ahead - {one.machine})
    return found


def circles(edges: Mapping[str, Iterable[str]]) -> list[tuple[str, ...]]:
    """The circles of a graph that a search by depth meets, each once and from its least member on."""
    found: dict[tuple[str, ...], None] = {}
    done: set[str] = set()

    def visit(one: str, way: list[str]) -> None:
        if one in way:
            circle = way[way.index(one) :]
            least = circle.index(min(circle))
            found[(*circle[least:], *circle[:least])] = None
        elif one not in done:
            for after in sorted(edges.get(one, ())):
                visit(after, [*way, one])
            done.add(one)

    for one in sorted(edges):
        visit(one, [])
    return list(found)


def orders(steps: Sequence[Step]) -> dict[str, set[Order]]:
    """For each machine of a tree, which places it holds while it takes others."""
    held: dict[str, list[str]] = {}
    found: dict[str, set[Order]] = {}
    for step in steps:
        mine = held.setdefault(step.machine, [])
        if step.hold and step.place not in mine:
            found.setdefault(step.machine, set()).update((before, step.place) for before in mine)
            mine.append(step.place)
        elif not step.hold and step.place in mine:
            mine.remove(step.place)
    return found


def crossing(all_orders: Mapping[str, Iterable[Order]]) -> list[tuple[tuple[str, str, str], ...]]:
    """Circles of places that several machines take in such orders that each may hold what the next one wants.

    Each is told as (machine, place that it holds, place that it takes). A machine alone cannot wait for itself.
    """
    by_order: dict[Order, list[str]] = {}
    for machine, some in sorted(all_orders.items()):
        for order in some:
            by_order.setdefault(order, []).append(machine)
    edges: dict[str, set[str]] = {}
    for before, after in by_order:
        edges.setdefault(before, set()).add(after)
    found = []
    for circle in circles(edges):
        pairs = list(zip(circle, (*circle[1:], circle[0]), strict=True))
        if (who := _different([by_order[pair] for pair in pairs])) is not None:
            found.append(tuple((machine, *pair) for machine, pair in zip(who, pairs, strict=True)))
    return found


def _different(choices: Sequence[Sequence[str]]) -> list[str] | None:
    """One of each choice, all different."""
    if not choices:
        return []
    for one in choices[0]:
        rest = _different([[other for other in some if other != one] for some in choices[1:]])
        if rest is not None:
            return [one, *rest]
    return None
