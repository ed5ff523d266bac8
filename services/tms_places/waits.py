"""Who waits for whom: among machines that wait now, and among those that may come to wait."""

import itertools
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from tms_places.claims import Book, Request


@dataclass(frozen=True)
class Step:
    """One node of a tree that takes or frees a place, in the order of the document."""

    machine: str
    place: str
    hold: bool


Order = tuple[str, str]  # a place that is held while the other one is taken


def missing(book: Book, one: Request) -> set[str]:
    """What a request still needs.

    A place that its machine gives back is needed again, if somebody else came first: else the fastest would keep it.
    Not while the machine is inside, as nobody else could get it then.
    """
    held, inside = book.held(one.machine), book.inside.get(one.machine, ())
    earlier = itertools.takewhile(lambda each: each != one, book.queue)
    wanted = {place for each in earlier if each.machine != one.machine for place in each.places}
    kept = {
        place
        for place, claim in held.items()
        if not claim.revoked and (claim.wants or place in inside or place not in wanted)
    }
    return set(one.places) - kept


def first(book: Book, one: Request, earlier: Iterable[Request]) -> list[Request]:
    """Those of earlier requests that must be served before this one.

    None, where its machine holds what somebody else waits for: each would wait for the other.
    """
    held = book.held(one.machine).keys()
    if any(not missing(book, each).isdisjoint(held) for each in book.queue if each.machine != one.machine):
        return []
    needs = missing(book, one)
    return [each for each in earlier if each.machine != one.machine and not needs.isdisjoint(missing(book, each))]


def waiting_for(book: Book) -> dict[str, set[str]]:
    """Machines, and those for which each waits: holders of what it wants, and who is first for the same."""
    found: dict[str, set[str]] = {}
    for number, one in enumerate(book.queue):
        ahead = {book.claims[place].machine for place in missing(book, one) & book.claims.keys()}
        ahead |= {each.machine for each in first(book, one, book.queue[:number])}
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
