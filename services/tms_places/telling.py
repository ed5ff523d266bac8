"""What people are told of shared places: why a machine waits, why a place is not freed, and who is in a circle."""

from tms_places.claims import Claim, Request
from tms_places.keeper import SILENT, Keeper
from tms_places.reasons import (
    HolderSilent,
    HolderUnheard,
    InsideStill,
    KeeperStarts,
    NotGivenBack,
    PlaceUncertain,
    RevokedBy,
    TwoInPlace,
    WaitingCircle,
)
from tms_places.waits import circles, waiting_for
from tms_reason.reason import Reason


def kept(keeper: Keeper, place: str, now: float) -> Reason | None:
    """Why nobody gets a place, where that needs words: its holder's run has done with it, or the keeper starts."""
    claim = keeper.book.claims.get(place)
    if claim is None:
        waits = any(place in one.places for one in keeper.book.queue)
        return KeeperStarts() if waits and not keeper.ready(now) else None
    if not claim.leaving:
        return None
    why = _stays(keeper, place, claim, now)
    return RevokedBy(claim.revoked, claim.machine, why) if claim.revoked else why


def _stays(keeper: Keeper, place: str, claim: Claim, now: float) -> Reason:
    """Why a place that its holder may give back is not free yet."""
    machine = claim.machine
    if machine not in keeper.told:
        return HolderUnheard(machine)
    at, report = keeper.told[machine]
    if now - at > SILENT:
        return HolderSilent(machine, now - at)
    if not report.sure:
        return PlaceUncertain(machine)
    return InsideStill(machine) if place in report.inside else NotGivenBack(machine)


def queue(keeper: Keeper, place: str) -> list[Request]:
    """Who waits for a place, the next one first."""
    return [one for one in keeper.book.queue if place in one.places]


def alarms(keeper: Keeper) -> list[Reason]:
    """What only a person can end: machines that wait in a circle, and two in one place."""
    book = keeper.book
    found: list[Reason] = [WaitingCircle((*circle, circle[0])) for circle in circles(waiting_for(book))]
    for place, claim in sorted(book.claims.items()):
        found += [TwoInPlace(one, place, claim.machine) for one in sorted(book.others_inside(place, claim.machine))]
    return found
