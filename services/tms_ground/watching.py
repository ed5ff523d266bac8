"""What the machines of a site tell becomes the ground and their loads; a file keeps both over a restart."""

import io
import json
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tms_config.clock import unix_time, utc_now
from tms_config.models import MachineModel
from tms_control.links import Matrix, placed
from tms_ground.journal import MOST, Journal, Looked, Told
from tms_ground.settings import Ground
from tms_ground.waiting import Waiting
from tms_ground.work import Duty, Work
from tms_machine.frames import FramePose
from tms_soil.absence import miss
from tms_soil.changes import Changes
from tms_soil.earth import GAP, Earth
from tms_soil.evidence import Evidence
from tms_soil.grid import Grid
from tms_soil.keeping import restore, state_of
from tms_soil.load import Load, load_of
from tms_soil.measuring import measured
from tms_soil.regions import soil_by_tile
from tms_soil.soils import Soil
from tms_soil.surface import Array, Heights
from tms_soil.surface import grid as unknown
from tms_work.cycle import Cycle

CELL = 1.0  # m, of a level ground
LATE = 0.25  # s without joint states, after which the way of an accelerated stand-in is unknown
TIMES, NEWEST = "evidence", "snapshot"  # names in the file
WORK, CYCLES = "work", "cycles"  # names in the file: what recognisers remember, and cycles that wait
JOURNAL = "journal"  # name in the file: number of the first journal that it does not hold


class Kept(NamedTuple):
    """What is to be on the disk."""

    ground: bytes  # with all work
    work: bytes  # the same once more: where the ground cannot be read, cycles go on with it


def touching(models: Mapping[str, MachineModel]) -> dict[str, MachineModel]:
    """The machines whose files tell what of them touches soil."""
    return {name: one for name, one in models.items() if one.bucket or one.vessel or one.blade or one.tracks}


class GroundWatch:
    """The ground, and where the machines were last told to be."""

    def __init__(
        self,
        ground: Ground,
        soils: Mapping[str, Soil],
        models: Mapping[str, MachineModel],
        file: Path,
        speed: float = 1.0,
    ) -> None:
        """`models`: by machine; `file` keeps the ground; `speed`: seconds of the machines in one of ours.

        `soils`: those that the site has, by name, that outside all regions first.
        """
        level = unknown(ground.area, CELL)
        level.z[:] = ground.level
        self.soils = list(soils)  # names, by the grid's index
        by_tile = soil_by_tile(level.bounds, [(self.soils.index(one.soil), one.corners) for one in ground.soils])
        self.earth = Earth(Grid.from_heights(level, list(soils.values()), by_tile), models, max(GAP, LATE * speed))
        self.area = ground.area  # m, map: what of the grid is the site
        self.changes = Changes(self.earth.grid)
        self._evidence = Evidence(self.earth.grid.bounds)
        self.newest = ""  # ISO 8601: time of the newest snapshot that this ground knows; empty: of none
        self.work = Work(self.earth, self.soils, models, speed)
        self.waiting = Waiting()
        self.file, self.copy = file, file.with_name("work.json")
        self.journal = Journal(file.with_suffix(".journal"))
        self._stands: dict[str, tuple[tuple[float, float, float], Matrix]] = {}  # machine -> place, base_link in map
        self._begun = self.earth.mass()
        self._first = 0  # number of the first journal that the loaded file does not hold
        self.changed = False  # since the last `content`
        self.touched = False  # since the last snapshot, by a machine

    @property
    def mass_error(self) -> float:
        """Mass that was made or lost since the start [kg]; not 0 is a fault of ours."""
        return self.earth.mass() - self._begun

    def take(self, machine: str, time: float, angles: Mapping[str, float], place: FramePose) -> None:
        """Take joint angles [rad] and the place of a machine at a time [s of the machines]."""
        at = place.x, place.y, place.yaw
        rolling = self.earth.bodies[machine].rolling
        kept = self._stands.get(machine)
        if kept is None or kept[0] != at:
            kept = self._stands[machine] = at, rolling.stand(*at) if rolling else placed(*at)
        if changed := self.earth.report(machine, time, angles, kept[1]):
            self.changed = self.touched = True
            self.changes.add(changed)
            self._evidence.add(changed, unix_time())
        self.journal.told(Told(machine, time, dict(angles), at), not changed)

    def miss(self, machine: str, seconds: float, angles: Mapping[str, float], place: FramePose) -> None:
        """Take what a machine that stands so now [rad] did while nobody looked, for `seconds` of its time."""
        at = place.x, place.y, place.yaw
        rolling = self.earth.bodies[machine].rolling
        found = miss(self.earth, machine, seconds, angles, rolling.stand(*at) if rolling else placed(*at))
        if found.changed or found.into:
            self.changed = self.work.filled = True  # to be kept at once, as no journal tells it
        self.changes.add(found.changed)
        self._evidence.add(found.changed, unix_time())
        self.work.missed(machine, found.into)

    def measured(self, seen: Heights, time: float, within: float = 0.0) -> None:
        """Take heights that were measured at a time [s since 1970]; see `measuring`."""
        changed, made = measured(self.earth.grid, self._evidence, seen, time, within)
        self._begun += made
        self.changes.add(changed)
        self._stands.clear()  # machines stand otherwise now
        self.changed = True

    def count(
        self, machine: str, now: float, angles: Mapping[str, float], place: FramePose, duty: Duty
    ) -> list[Cycle]:  # fmt: skip
        """Cycles of work that have ended by `now` [s since 1970]; they wait for the database from now on."""
        cycles = self.work.take(machine, now, angles, place, duty)
        self.waiting.put(cycles)
        self.changed = self.changed or bool(cycles)
        self.journal.looked(Looked(machine, now, duty))
        return cycles

    def stands(self, machine: str) -> Matrix | None:
        """Its base_link in map, by height and slope under its tracks; None while it has told no place."""
        kept = self._stands.get(machine)
        return None if kept is None else kept[1]

    def loads(self) -> dict[str, Load]:
        """Of buckets and vessels, by machine."""
        parts = ((name, body.digger or body.hauler) for name, body in self.earth.bodies.items())
        return {name: load_of(part, self.earth.grid) for name, part in parts if part is not None}

    def ages(self, cells: Heights) -> Array:
        """How old the newest evidence of some cells is [s]; NaN: there is none."""
        return unix_time() - self._evidence.at(*cells.centres)

    def load(self) -> bool:
        """Go on with the kept ground; False where there is none, or it is one of another area or soil.

        Raises:
            OSError, ValueError: the file cannot be read.
        """
        if not self.file.exists():
            return False
        try:
            with np.load(io.BytesIO(self.file.read_bytes()), allow_pickle=False) as file:
                state = dict(file)  # all of it, before anything changes
            found = restore(self.earth, state)
            if found:
                self._remember(state)
                self.touched = True
        except (zipfile.BadZipFile, KeyError, EOFError) as error:
            raise ValueError(str(error)) from error
        self._begun = self.earth.mass()
        return found

    def load_work(self, loads: bool) -> None:
        """Go on with the kept work; `loads`: whether `load` has brought the loads of the same file back.

        Raises:
            ValueError: it is of a release that knows it otherwise.
        """
        with np.load(io.BytesIO(self.file.read_bytes()), allow_pickle=False) as file:
            if WORK in file:  # files of earlier releases have none
                self.work.restore(_text(file[WORK]), loads)
                self.waiting.restore(_text(file[CYCLES]))

    def load_copy(self) -> None:
        """Go on with the second copy of the work; nobody knows what has become of the loads.

        Raises:
            OSError, ValueError: it cannot be read.
        """
        try:
            found = json.loads(self.copy.read_text(encoding="utf-8"))
            self.work.restore(json.dumps(found[WORK]), loads=False)
            self.waiting.restore(json.dumps(found[CYCLES]))
        except (KeyError, TypeError) as error:
            raise ValueError(str(error)) from error

    def replay(self) -> dict[str, float]:
        """Take what machines have told since the file was written; returns when each was looked at last [s since 1970].

        After `load`, and before the journal is begun.
        """
        last: dict[str, Told] = {}
        looked: dict[str, float] = {}
        for line in self.journal.lines(self._first):
            if line.machine not in self.earth.bodies:
                continue
            if isinstance(line, Told):
                last[line.machine] = line
                self.take(line.machine, line.time, line.angles, FramePose(*line.place, 0.0))
            elif (told := last.get(line.machine)) is not None:
                looked[line.machine] = line.now
                self.count(line.machine, line.now, told.angles, FramePose(*told.place, 0.0), Duty(*line.duty))
        self.changed = self.changed or bool(looked)
        return looked

    def _remember(self, state: Mapping[str, Any]) -> None:
        """When the kept ground was known; files of earlier releases say nothing: then all of it counts as of now."""
        now = unix_time()
        self._first = int(state[JOURNAL]) if JOURNAL in state else self.journal.number + 1
        times = state.get(TIMES)
        if times is None or times.shape != self._evidence.times.shape:
            self._evidence.times[:], self.newest = now, utc_now().isoformat()
        else:
            self._evidence.times[:], self.newest = np.minimum(times, now), str(state[NEWEST])

    def content(self) -> Kept | None:
        """What `file` and `copy` must hold to keep ground and work; None if nothing has changed since the last call.

        What is told from now on goes into another journal than what was told before.
        """
        if not self.changed and self.journal.size < MOST:
            return None
        self.changed = self.work.filled = False
        self.journal.begin()
        out, work, cycles = io.BytesIO(), self.work.state(), self.waiting.state()
        more = {TIMES: self._evidence.times, NEWEST: np.array(self.newest), JOURNAL: np.array(self.journal.number)}
        works = {WORK: _bytes(work), CYCLES: _bytes(cycles)}
        np.savez(out, **state_of(self.earth), **more, **works)  # type: ignore[arg-type]
        return Kept(out.getvalue(), f'{{"{WORK}": {work}, "{CYCLES}": {cycles}}}'.encode())


def _bytes(text: str) -> NDArray[np.uint8]:
    return np.frombuffer(text.encode(), np.uint8)


def _text(data: NDArray[np.uint8]) -> str:
    return data.tobytes().decode()
