"""Release areas in the gateway: reports to the keeper of shared places, and what its leases open to the machine.

The gateway's own lease is what counts while the machine moves. It is renewed in a thread of its own; without tms:db
it runs out, and the machine is held where it would go on in such an area.
"""

import threading
from collections.abc import Callable, Mapping, Sequence

from tms_msg_areas.msg import Place, Places
from tms_msg_areas.srv import ReportPlaces

from tms_areas.areas import Area, AreaSet
from tms_areas.fix import Seen
from tms_areas.guard import Guard
from tms_areas.reach import Place as Pose
from tms_areas.release import Presence, corners_of, needed, straight
from tms_config.clock import monotonic, unix_ns
from tms_machine.asking import ask
from tms_places.keeper import Leases
from tms_places.leases import PERIOD, SOON, OwnLeases
from tms_places.reasons import LeaseOver, OnlyOut, PlacesNeeded
from tms_reason.errors import RosError
from tms_reason.reason import Reason
from tms_runtime.app import App

LIMIT = 2.0  # s for the keeper to answer
AGAIN = 1.0  # s after a report that was not answered
Guards = Callable[[frozenset[str]], Guard]  # the guard of a machine that holds some places


class PlaceWatch:
    """The leases of one machine."""

    def __init__(self, app: App) -> None:
        self._app, self._own, self._lock = app, OwnLeases(app.machine), threading.Lock()
        self._areas: tuple[Area, ...] = ()
        self._presence = Presence()  # of the thread that looks
        self._inside: frozenset[str] = frozenset()
        self._sure, self._due, self._silent = False, 0.0, False
        app.ros.subscribe(Places, "/tms/places", self._heard, latched=True)
        app.ros.poll_in_thread(SOON, self._report, "places")

    def enable(self, areas: AreaSet) -> None:
        """The release areas of a set that counts from now on."""
        with self._lock:
            self._areas = areas.of("release")
            self._own.evacuates = frozenset(one.id for one in self._areas if one.on_loss == "evacuate")

    @property
    def open(self) -> frozenset[str]:
        """Places that are not closed to the machine."""
        with self._lock:
            return self._own.open

    # the look

    def look(self, guard: Guard, joints: Mapping[str, float], seen: Seen, drives: bool) -> Reason | None:
        """Where the machine is now; and why its tracks must be held: a lease that is over, where it is or may come.

        Geometry is done outside of the lock, for which the executor thread may wait.
        """
        areas, there = self._areas, self._presence
        if not areas:
            return None
        there.look(guard.law, guard.body(joints), seen, areas, drives, monotonic())
        lost = self._seen_there(seen.unsure is None, drives) - self._own.evacuates
        if not lost & there.near or not drives or seen.motion is None:
            return None
        return LeaseOver(self._app.machine, min(lost & there.near))

    def _seen_there(self, sure: bool, drives: bool) -> frozenset[str]:
        """Note where the machine is, and give back what nobody wants; the places whose lease is over."""
        inside = self._presence.inside
        with self._lock:
            before = (self._inside, self._sure, self._own.using)
            self._inside, self._sure = inside, sure
            self._own.give_back(self._presence.near, sure, drives)
            if before != (inside, sure, self._own.using):
                self._due = 0.0
            return self._own.lost(monotonic())

    # goals

    def judged(
        self, guards: Guards, seen: Seen, joints: Mapping[str, float], way: Sequence[Pose], told: bool
    ) -> Reason | None:
        """Why tracks must not go a way; PlacesNeeded, if it lacks nothing but these. As Guard.may_drive."""
        with self._lock:
            areas, inside = self._areas, self._inside
            lost = self._own.lost(monotonic())
            usable = self._own.open - ((lost | self._own.leaving) - inside)
            evacuates = self._own.evacuates
        stuck = inside & lost
        if stuck - evacuates:
            return LeaseOver(self._app.machine, min(stuck - evacuates))
        if stuck and seen.motion is not None:
            outside = guards(usable - lost)
            if outside.law.arriving(outside.body(joints), way[-1], seen.motion.off) is not None:
                return OnlyOut(self._app.machine, min(stuck))
        likely: frozenset[str] = frozenset()
        if not told and seen.motion is not None:
            here = (seen.motion.x, seen.motion.y, seen.motion.yaw)
            radius = max(part.spin for part in guards(usable).body(joints).parts)
            likely = straight(areas, corners_of(here, way), radius) - usable
        found, wrong = needed(areas, likely, lambda more: guards(usable | more).may_drive(seen, joints, way, told))
        if wrong is not None or not found:
            return wrong
        return PlacesNeeded(self._app.machine, tuple(sorted(found)))

    # the keeper

    def _heard(self, told: Places) -> None:
        """Report soon what the keeper waits for; what nobody wants any more is no way for the next goal."""
        machine = self._app.machine
        mine = {one.name: one.state for one in told.places if one.holder == machine}
        left = frozenset(name for name, state in mine.items() if state == Place.LEAVING)
        with self._lock:
            news = left - self._own.leaving or any(state in (Place.GRANTED, Place.REVOKED) for state in mine.values())
            self._own.heard(mine, left, told.revision)
            if news or mine.keys() != self._own.open:
                self._due = 0.0

    def _report(self) -> None:
        now = monotonic()
        with self._lock:
            if not self._areas or now < self._due:
                return
            names = [one.id for one in self._areas]
            report = self._own.report(unix_ns(), names, self._inside, self._sure, now)
            self._due = now + PERIOD
        request = ReportPlaces.Request(
            machine=report.machine, number=report.number, places=sorted(report.places), inside=sorted(report.inside),
            sure=report.sure, in_use=sorted(report.using), revision=report.revision,
        )  # fmt: skip
        try:
            answer = ask(self._app.ros, ReportPlaces, "/tms/places/report", request, LIMIT)
        except RosError as error:
            if not self._silent:
                self._app.log.warning("places_not_renewed", reason=error.reason)
            self._silent, self._due = True, now + AGAIN
            return
        self._silent = False
        told = Leases(frozenset(answer.held), frozenset(answer.leaving), frozenset(answer.revoked), answer.revision)
        with self._lock:
            self._own.answered(report.number, told, self._inside, answer.lease)
            if self._own.using != report.using:
                self._due = 0.0  # the keeper waits for the word that the gateway knows
