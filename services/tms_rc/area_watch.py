"""Watches a machine by the enabled areas, in a thread of its own: no stop waits for geometry, nor for a lock of it."""

import math
import threading
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import replace
from queue import SimpleQueue
from typing import Any

from sensor_msgs.msg import NavSatFix

from tms_areas.areas import SHOWN, AreaSet, Point
from tms_areas.body import Silhouette
from tms_areas.braking import tracks_of
from tms_areas.escape import SPEED, Escape
from tms_areas.fix import Fix, Seen
from tms_areas.guard import Guard, Verdict
from tms_areas.law import Law
from tms_config.clock import monotonic, unix_time
from tms_decision.gateway.effects import Receipt
from tms_decision.gateway.state import Gateway
from tms_decision.reasons import ProcessLost
from tms_machine.border import MotionAction
from tms_machine.places import Places
from tms_proof.standstill import HEADING, ODOM, PLACE
from tms_rc.area_file import AreaFile, Enabled
from tms_rc.braking_file import BrakingFile
from tms_rc.motion_goals import frame_of, places_of, way_of
from tms_rc.place_watch import PlaceWatch
from tms_rc.reasons import (
    AreasLate,
    AreasNotEnabled,
    AreasNotKept,
    EscapesAtRest,
    GoalNotInMap,
    NothingToEscape,
    TrapsMachine,
)
from tms_rc.speed_limit import SpeedLimit
from tms_reason.errors import TmsError
from tms_reason.reason import Reason
from tms_runtime.app import App

PERIOD = 0.04  # s between looks; with the beats it stays within tms_areas.law.BEAT
FIXES = 10  # messages of a GNSS that may come between two looks
SPEEDS = 500  # looks that are kept until a receipt comes: it waits for the proof of the stop, and for the disk
AROUND = 0.3  # s around the begin of a stop whose highest speed counts
LATE = 0.3  # s; an older verdict is none
TOLD = ("follow_path",)  # actions whose poses are the way itself; for others a planner chooses it


class AreaWatch:
    """The law of areas in one gateway."""

    def __init__(
        self, app: App, gateway: Gateway, drives: Callable[[int], bool], tell: Callable[[str, str, str, float], None]
    ) -> None:
        """`drives`: whether the goal with a number moves the tracks; `tell`: of acts of persons (acts.py)."""
        site, machine = app.site, app.machine
        self._app, self._gateway, self._drives, self._tell = app, gateway, drives, tell
        self._model, self._border = site.model_of(machine), site.border(machine)
        self._file, self._silhouette = AreaFile(site.state, machine), Silhouette(self._model)
        self._places = Places(app.ros, {machine: self._border})
        self._shared = PlaceWatch(app)
        drive = self._model.drive
        gnss = site.file.machines[machine].fix
        self._fix = Fix(drive.turn_velocity if drive is not None else 0.0, rtk=gnss is not None)
        self._fixing = threading.Lock()
        self._fixes = None if gnss is None else app.ros.sample_arrivals(NavSatFix, f"/{machine}/{gnss}", FIXES)
        self._told = 0.0  # when the last pose that was taken came
        self._enabling = threading.Lock()
        self.speed = SpeedLimit(app)
        self.stops: SimpleQueue[Receipt] = SimpleQueue()  # receipts that may show worse brakes
        self._braking = BrakingFile(site.state, machine)
        tracks = tracks_of(self._model, self._border)
        self._tracks = None if tracks is None else replace(tracks, factor=self._braking.read())
        self._speeds: deque[tuple[float, float]] = deque(maxlen=SPEEDS)  # s since 1970, m/s
        # Replaced, never changed: read without a lock.
        self.enabled: Enabled | None = None
        self._guard: Guard | None = None
        self._escape: Escape | None = None  # in its place, while a person lets the machine back in
        self._escape_since = 0.0  # s since 1970
        self._problem: Reason | None = None
        self._verdict: tuple[float, int, Verdict] | None = None  # when, of which goal
        self._seen = Seen(None, None)
        self._read()
        app.ros.poll_in_thread(PERIOD, self._look, "areas")

    # what others ask; none of it waits

    @property
    def here(self) -> Point | None:
        """Where the machine is believed to be [m, map]."""
        motion = self._seen.motion
        return None if motion is None or self._seen.unsure is not None else (motion.x, motion.y)

    def unready(self) -> Reason | None:
        """Why the machine must not be moved at all now."""
        return self._problem or self._seen.unsure

    def astray(self, gateway: Gateway) -> Reason | None:
        """Why the active goal must not go on: a loss, if that may pass by itself."""
        active, now = gateway.active, monotonic()
        if active is None:
            return None
        if self._problem is not None:
            return self._problem
        if self._verdict is None or self._verdict[1] != active.number:
            return None if now - active.since < LATE else ProcessLost(AreasLate(LATE))
        at, _, verdict = self._verdict
        if verdict.stop is not None:
            return verdict.stop
        if now - at > LATE:
            return ProcessLost(AreasLate(now - at))
        return None if verdict.hold is None else ProcessLost(verdict.hold)

    # goals, in their threads

    def problem(self, motion: MotionAction, request: Any, joints: Mapping[str, float]) -> Reason | None:
        """Why a goal must not begin, from where the machine is now."""
        escape, guard = self._escape, self._guard
        if guard is None:
            return self._problem
        seen = self._now()
        if (places := places_of(request)) is not None:
            frame = frame_of(request)
            if frame:
                return GoalNotInMap(frame)
            if escape is not None:
                return escape.may_drive(seen, joints, places, told=motion.field in TOLD)
            return self._shared.judged(self._holding, seen, joints, places, told=motion.field in TOLD)
        return (escape or guard).may_work(seen, [joints, *way_of(request, self._model.turned(motion.field))])

    # people

    def enable(self, areas: AreaSet, who: str, only_check: bool) -> None:
        """Let areas count from now on, once they are on the disk.

        Raises:
            TmsError: the machine moves, and they would stop it; or they could not be written.
        """
        with self._enabling:
            guard = self._made(areas)
            self._check_free(guard)
            if only_check:
                return
            enabled = Enabled(areas, who, unix_time())
            try:
                self._file.keep(enabled)
            except OSError as error:
                raise TmsError(AreasNotKept(str(error.strerror))) from error
            self._enabled(enabled, guard)
        self._app.log.info("areas_enabled", set=areas.id, who=who)

    def _enabled(self, enabled: Enabled, guard: Guard) -> None:
        self._shared.enable(enabled.areas)
        self.enabled, self._guard, self._problem = enabled, guard, None
        self._escape = None
        target = f"{self._app.machine} {enabled.areas.id[:SHOWN]}"
        self._tell("enable_areas", target, enabled.who, enabled.at)  # at each start again: the audit may be new

    def escape(self, who: str) -> None:
        """Let the machine, which stands outside, be moved back in, until it is there or is stopped: escape.py.

        Raises:
            TmsError: it is inside, is not armed, moves, or its place is not believed.
        """
        gateway, machine = self._gateway, self._app.machine
        with self._enabling:
            guard, seen = self._guard, self._now()
            if guard is None:
                raise TmsError(self._problem or AreasNotEnabled())
            if gateway.latch.cause is not None or gateway.active is not None or gateway.watch.moving():
                raise TmsError(EscapesAtRest(machine))
            if seen.unsure is not None:
                raise TmsError(seen.unsure)
            escape = Escape(guard.law, self._silhouette)
            if escape.over(seen, gateway.watch.positions):
                raise TmsError(NothingToEscape(machine))
            self._escape, self._escape_since = escape, unix_time()
        self._tell("escape", machine, who, self._escape_since)
        self._app.log.warning("escape", who=who)

    def _pace(self, seen: Seen) -> None:
        """Limit the speed of the tracks: before an area that limits it, and on the way back."""
        if (guard := self._guard) is not None:
            self.speed.set("areas", guard.pace(seen, self._gateway.watch.positions))
            self.speed.set("escape", math.inf if self._escape is None else SPEED)

    def _check_free(self, guard: Guard) -> None:
        active = self._gateway.active
        if active is None and not self._gateway.watch.moving():
            return
        tracks = active is None or self._drives(active.number)
        verdict = guard.look(self._now(), self._gateway.watch.positions, tracks)
        why = verdict.stop or verdict.hold
        if why is not None:
            raise TmsError(TrapsMachine(self._app.machine, why))

    # the watch

    def _read(self) -> None:
        try:
            found = self._file.read()
        except TmsError as error:
            self._problem = error.reason
            return
        self._enabled(found, self._made(found.areas))

    def _made(self, areas: AreaSet) -> Guard:
        return self._guard_of(areas, self._shared.open)

    def _guard_of(self, areas: AreaSet, held: frozenset[str]) -> Guard:
        return Guard(Law(areas, self._app.machine, self._tracks, held, slow=self.speed.able), self._silhouette)

    def _holding(self, held: frozenset[str]) -> Guard:
        """The guard that counts for a holder of some places."""
        guard = self._guard
        assert guard is not None, "areas are enabled"
        return guard if guard.law.held == held else self._guard_of(guard.law.areas, held)

    def _now(self) -> Seen:
        with self._fixing:
            return self._fix.look(monotonic())

    def _look(self) -> None:
        self._places.take()
        place, deviation = self._places.place(self._app.machine), self._places.deviation(self._app.machine)
        odom = self._gateway.watch.sources.get(ODOM)
        last = {} if odom is None else {name: one.last for name, one in odom.channels.items()}
        speed, turning = (one.speed or 0.0 if (one := last.get(name)) else 0.0 for name in (PLACE, HEADING))
        with self._fixing:
            self._fix.odometry(speed, turning)
            if place is not None and place.received > self._told:
                self._told = place.received
                self._fix.heard(place.received, place.x, place.y, place.yaw, deviation)
            for fix in self._fixes() if self._fixes is not None else ():
                self._fix.fixed(fix.received, fix.message.status.status)
            seen = self._seen = self._fix.look(monotonic())
        if seen.unsure is None and seen.motion is not None:
            self._speeds.append((unix_time(), math.hypot(seen.motion.vx, seen.motion.vy)))
        self._take_stops()
        if (escape := self._escape) is not None and escape.over(seen, self._gateway.watch.positions):
            self._escaped()
        self._pace(seen)
        active, guard = self._gateway.active, self._guard
        drives = active is not None and self._drives(active.number)
        lease = None if guard is None else self._leases(guard, seen, drives)
        escape, guard = self._escape, self._guard
        if active is not None and guard is not None:
            at = monotonic()
            verdict = (escape or guard).look(seen, self._gateway.watch.positions, drives)
            if lease is not None and escape is None and verdict.stop is None:
                verdict = Verdict(hold=lease)
            self._verdict = at, active.number, verdict

    def _leases(self, guard: Guard, seen: Seen, drives: bool) -> Reason | None:
        """Why the tracks must be held for a lease; places that were got or given back count from now on."""
        lease = self._shared.look(guard, self._gateway.watch.positions, seen, drives)
        if self._shared.open != guard.law.held:
            with self._enabling:
                if self.enabled is not None:
                    self._guard = self._made(self.enabled.areas)
        return lease

    def _take_stops(self) -> None:
        while not self.stops.empty():
            stop = self.stops.get()
            self._learn(stop)
            if self._escape is not None and stop.stamp >= self._escape_since:
                self._escaped()

    def _escaped(self) -> None:
        with self._enabling:
            self._escape = None
        self._app.log.info("escape_over")

    def _learn(self, stop: Receipt) -> None:
        """Enlarge the distances if a stop from a known speed took longer than the model says."""
        speed = max((one for at, one in self._speeds if abs(at - stop.stamp) < AROUND), default=0.0)
        tracks = self._tracks
        if tracks is None or (learned := tracks.learned(speed, stop.way)) == tracks:
            return
        with self._enabling:
            self._tracks = learned
            if self.enabled is not None:
                self._guard = self._made(self.enabled.areas)
        self._app.log.warning("brakes_worse", factor=round(learned.factor, 2), speed=round(speed, 2), m=stop.way)
        try:
            self._braking.keep(learned.factor)
        except OSError as error:
            self._app.log.error("braking_not_kept", reason=str(error))
