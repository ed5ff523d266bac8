"""Keeper, gateway and subtask hear of each other at different times: who is told that it holds a place may go there."""

import random
from collections import deque

import pytest

from tms_places.claims import Book
from tms_places.keeper import Keeper, Leases, Report
from tms_places.leases import OwnLeases

ROAD = frozenset({"road"})
NONE: frozenset[str] = frozenset()


class Site:
    """One place; a gateway and a subtask, which hear what the keeper tells all after different times, in its order."""

    def __init__(self, seed: int) -> None:
        self.random, self.now = random.Random(seed), 0.0
        self.keeper, self.own = Keeper(("a", "b"), Book(), 0.0), OwnLeases("a")
        self.keeper.report(Report("b", 1, ROAD, NONE, True, NONE), 0.0, 0.0)
        self.to_gateway, self.to_subtask = deque[tuple[frozenset[str], int]](), deque[tuple[bool, int]]()
        self.reports, self.answers = list[Report](), list[tuple[int, Leases]]()
        self.held = False  # as the subtask was told
        self.wanted, self.since = False, 0

    def change(self) -> None:
        self.keeper.grant(self.now, self.now)
        claim = self.keeper.book.claims.get("road")
        mine = claim is not None and claim.machine == "a"
        self.to_gateway.append((ROAD if mine and claim and claim.leaving else NONE, self.keeper.book.revision))
        held = bool(mine and claim and claim.confirmed and not claim.leaving)
        self.to_subtask.append((held, self.keeper.book.revision))

    def want(self) -> None:
        if not self.wanted:
            self.keeper.hold("a", "run", ROAD, self.now)
            self.change()
            self.wanted, self.since = True, self.keeper.book.revision

    def free(self) -> None:
        if self.wanted:
            self.keeper.free("a", "run", ROAD)
            self.wanted = self.held = False
            self.change()

    def report(self) -> None:
        if not self.reports and not self.answers:  # one at a time
            self.reports.append(self.own.report(0, ROAD, NONE, True, self.now))

    def arrive(self) -> None:
        if self.reports:
            told = self.reports.pop(0)
            self.keeper.report(told, self.now, self.now)
            self.change()
            self.answers.append((told.number, self.keeper.leases("a")))

    def answer(self) -> None:
        if self.answers:
            number, told = self.answers.pop(0)
            self.own.answered(number, told, NONE)

    def gateway_hears(self) -> None:
        if self.to_gateway:
            leaving, revision = self.to_gateway.popleft()
            self.own.heard(ROAD, leaving, revision)

    def subtask_hears(self) -> None:
        if self.to_subtask:
            held, revision = self.to_subtask.popleft()
            self.held = held and self.wanted and revision >= self.since

    def stand(self) -> None:
        self.own.give_back(NONE, sure=True, drives=False)

    def step(self) -> None:
        self.now += 0.01
        hears = (self.report, self.arrive, self.answer, self.gateway_hears, self.subtask_hears, self.stand)
        self.random.choices((self.want, self.free, *hears), (1, 1, 9, 9, 9, 9, 9, 9))[0]()


@pytest.mark.parametrize("seed", range(40))
def test_who_is_told_that_it_holds_a_place_may_go_there_at_once(seed: int) -> None:
    site, granted = Site(seed), 0
    for _ in range(1000):
        site.step()
        if site.held:
            granted += 1
            assert site.own.held(site.now) == ROAD
    assert granted
