"""Keeps shared places: serves /tms/places/*, and tells all on /tms/places.

What it grants is in the database before an answer leaves. While the store is away nothing changes hands, and leases
are renewed as they were.
"""

import threading
from collections.abc import Callable
from typing import TypeVar

from prometheus_client import Gauge
from tms_msg_areas.msg import Place, PlaceRequest, Places
from tms_msg_areas.srv import AskPlaces, ReportPlaces, RevokePlace
from tms_msg_db.msg import Event

from tms_config.clock import monotonic, unix_time
from tms_db.connection import StoreConnection
from tms_db.place_book import PlaceBook
from tms_db.store import Db
from tms_interfaces.generated import Coded
from tms_machine import stamps
from tms_places.claims import Claim
from tms_places.keeper import LEASE, Keeper, Report
from tms_places.reasons import PlacesUnread
from tms_places.telling import alarms, kept, queue
from tms_reason.errors import DbError, TmsError
from tms_reason.wire import to_line
from tms_runtime.app import App

ACTS = 20  # of persons that are told to an audit that comes later
TICK = 1.0  # s between looks whether something is to be granted or told
ALARMS = Gauge(
    "tms_db_place_alarms", "Machines that wait for each other in a circle, and machines in a place of another"
)
T = TypeVar("T")


class PlaceServices:
    """The keeper of the site's places."""

    def __init__(self, app: App, db: Db, connection: StoreConnection) -> None:
        self._app, self._connection, self._stored = app, connection, PlaceBook(db)
        self._lock = threading.Lock()
        self._keeper: Keeper | None = None  # until the book was read
        self._told: Places | None = None  # also an empty one is told: nobody need wait for more
        self._publisher = app.ros.publisher(Places, "/tms/places", depth=1, latched=True)
        self._acts = app.ros.publisher(Event, "/tms/places/acts", depth=ACTS, latched=True)

    def offer(self) -> None:
        ros = self._app.ros
        ros.offer_slow(AskPlaces, "/tms/places/ask", self.ask)
        ros.offer_slow(ReportPlaces, "/tms/places/report", self.report)
        ros.offer_slow(RevokePlace, "/tms/places/revoke", self.revoke)
        ros.poll_in_thread(TICK, self.tick, "places")

    # services

    def ask(self, request: AskPlaces.Request, response: AskPlaces.Response) -> AskPlaces.Response:
        def act(keeper: Keeper) -> None:
            if request.hold:
                keeper.hold(request.machine, request.run, request.places, unix_time())
            else:
                keeper.free(request.machine, request.run, request.places)

        def answer() -> None:
            self._change(act)
            response.revision = self._read().book.revision

        self._answer(response, answer)
        return response

    def report(self, request: ReportPlaces.Request, response: ReportPlaces.Response) -> ReportPlaces.Response:
        told = Report(request.machine, request.number, frozenset(request.places), frozenset(request.inside),
                      request.sure, frozenset(request.in_use), request.revision)  # fmt: skip

        def answer() -> None:
            try:
                self._change(lambda keeper: keeper.report(told, monotonic(), unix_time()))
            except DbError:
                if self._keeper is None:
                    raise
            with self._lock:
                leases = self._read().leases(request.machine)
            response.lease = LEASE
            response.held, response.leaving = sorted(leases.held), sorted(leases.leaving)
            response.revoked, response.revision = sorted(leases.revoked), leases.revision

        self._answer(response, answer)
        return response

    def revoke(self, request: RevokePlace.Request, response: RevokePlace.Response) -> RevokePlace.Response:
        def answer() -> None:
            response.holder = self._change(lambda keeper: keeper.revoke(request.place, request.who))
            act = Event(stamp=stamps.time(unix_time()), kind="revoke_place", text=request.who)
            act.node = f"{request.place} of {response.holder}"
            self._acts.publish(act)
            self._app.log.warning("place_revoked", place=request.place, holder=response.holder, who=request.who)

        self._answer(response, answer)
        return response

    def _answer(self, response: Coded, act: Callable[[], None]) -> None:
        try:
            act()
        except TmsError as error:
            response.error_code, response.error_msg = error.code, to_line(error.reason)

    # the keeper

    def tick(self) -> None:
        """Grant what has become free, and tell what has changed with time alone."""
        try:
            self._change(lambda _: None)
        except DbError:
            with self._lock:
                self._tell()

    def _change(self, act: Callable[[Keeper], T]) -> T:
        """Let something happen, and keep what has changed in the database; else it did not happen.

        Raises:
            TmsError: it is refused, or the store is away.
        """
        with self._lock:
            keeper = self._read()
            before = keeper.book
            try:
                answer = act(keeper)
                keeper.grant(monotonic(), unix_time())
                if keeper.book != before:
                    with self._connection.use():
                        self._stored.write(keeper.book)
            except TmsError:
                keeper.book = before
                raise
            self._tell()
            return answer

    def _read(self) -> Keeper:
        if self._keeper is None:
            if self._connection.unready() is not None:
                raise DbError(PlacesUnread(), "STORE_DOWN")
            with self._connection.use():
                self._keeper = Keeper(self._app.site.file.machines, self._stored.read(), monotonic())
        return self._keeper

    # what is told

    def _tell(self) -> None:
        if self._keeper is None:
            return
        told = _message(self._keeper, monotonic())
        if told != self._told:
            before = [] if self._told is None else self._told.alarms
            for alarm in sorted(set(told.alarms) - set(before)):
                self._app.log.error("alarm", reason=alarm)
            ALARMS.set(len(told.alarms))
            self._told = told
            self._publisher.publish(told)


def _message(keeper: Keeper, now: float) -> Places:
    names = sorted({*keeper.book.places, *keeper.book.claims})
    return Places(
        revision=keeper.book.revision,
        places=[_place(keeper, name, now) for name in names],
        alarms=[to_line(alarm) for alarm in alarms(keeper)],
    )


def _place(keeper: Keeper, name: str, now: float) -> Place:
    claim = keeper.book.claims.get(name)
    told = Place(name=name, state=_state(claim), reason=to_line(kept(keeper, name, now)))
    told.queue = [
        PlaceRequest(machine=one.machine, run=one.run, since=stamps.time(one.since)) for one in queue(keeper, name)
    ]
    if claim is not None:
        told.holder, told.run, told.since = claim.machine, max(claim.wants, default=""), stamps.time(claim.since)
    return told


def _state(claim: Claim | None) -> int:
    if claim is None:
        return int(Place.FREE)
    if claim.revoked:
        return int(Place.REVOKED)
    if claim.leaving:
        return int(Place.LEAVING)
    return int(Place.HELD if claim.confirmed else Place.GRANTED)
