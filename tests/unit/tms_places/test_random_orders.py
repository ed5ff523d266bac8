"""Random requests, releases, reports and restarts: what must hold of every book, judged without the keeper's code."""

import random

import pytest

from tms_places.claims import Book, of_document, to_document
from tms_places.keeper import Keeper, Report
from tms_places.reasons import WaitingCircle
from tms_places.telling import alarms

PLACES = ("p", "q", "r", "s")
MACHINES = ("a", "b", "c", "d")


def stuck(keeper: Keeper) -> set[str]:
    """Machines that can never go on: those are left whose wishes the others never leave open."""
    wants: dict[str, set[str]] = {}
    for one in keeper.book.queue:
        wants.setdefault(one.machine, set()).update(one.places)
    has = {name: {place for place, one in keeper.book.claims.items() if one.machine == name} for name in wants}
    left = set(wants)
    while free := {name for name in left if not any((wants[name] - has[name]) & has[other] for other in left - {name})}:
        left -= free
    return left


@pytest.mark.parametrize("seed", range(15))
def test_books(seed: int) -> None:
    r, now = random.Random(seed), 0.0
    keeper, where = Keeper(MACHINES, Book(), 0.0), dict[str, frozenset[str]]()
    for number in range(1, 120):
        now += 0.5
        machine = r.choice(MACHINES)
        if number > len(MACHINES):
            act = r.choice(
                ["hold", "hold", "free", "enter", "leave", "restart"] if r.random() < 0.2 else ["hold", "free"]
            )
        else:
            machine, act = MACHINES[number - 1], "leave"
        if act == "hold" and not any(one.machine == machine for one in keeper.book.queue):
            keeper.hold(machine, "run", r.sample(PLACES, r.choice([1, 1, 2])), now)
        elif act == "free" and r.random() < 0.3:
            keeper.free(machine, "run", ())
        elif act == "restart":
            keeper = Keeper(MACHINES, of_document(to_document(keeper.book)), now)
        elif act == "enter" and keeper.leases(machine).held:
            where[machine] = frozenset({min(keeper.leases(machine).held)})
        elif act == "leave":
            where[machine] = frozenset()
        for one in MACHINES:
            inside = where.get(one, frozenset())
            using = keeper.leases(one).held | inside
            number_of = number * 10
            keeper.report(Report(one, number_of, frozenset(PLACES), inside, True, using), now, now)
        keeper.grant(now, now)
        for one, inside in where.items():
            assert all(keeper.book.claims[place].machine == one for place in inside)
        told = {name for why in alarms(keeper) if isinstance(why, WaitingCircle) for name in why.circle}
        assert bool(stuck(keeper)) == bool(told), "circles are told, and nothing else is"
        assert told <= stuck(keeper)
        idle = [one for one in keeper.book.queue if not any(place in keeper.book.claims for place in one.places)]
        assert not idle or keeper.book.queue[0] not in idle, "nobody waits first of all for what is free"
