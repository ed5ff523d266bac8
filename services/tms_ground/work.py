"""What machines do to the ground as cycles of work: samples of their loads and motions for the recognisers.

Machines of a simulated site may live faster than we do. Recognisers count in the machines' seconds; a cycle is dated by
our clock at its end, and lasts as long as it took the machine.
"""

import json
import math
from collections.abc import Mapping, Sequence
from datetime import datetime, timezone
from typing import Any, NamedTuple

from tms_config.models import MachineModel
from tms_machine.frames import FramePose
from tms_soil.capacity import Capacity
from tms_soil.digging import Digger
from tms_soil.earth import Body, Earth
from tms_soil.hauling import Hauler
from tms_soil.load import load_of
from tms_work.cycle import Cycle, Kind
from tms_work.recogniser import STEP, Recogniser
from tms_work.sample import Amount, Sample
from tms_work.ways import CARRIER, EXCAVATOR

SWING = "swing_joint"  # of an excavator's upper body
EARLY = 1e-3  # s; two looks STEP apart are so only nearly


class Duty(NamedTuple):
    """What scheduler and gateway tell of a machine."""

    run: str = ""  # that holds it; empty: none
    moves: bool = False  # a joint or a track
    stopped: bool = False  # latched or held


class _Swing(NamedTuple):
    time: float  # s since 1970, of the machines
    angle: float  # rad


class Work:
    """The cycles of a site's excavators and carriers."""

    def __init__(
        self, earth: Earth, soils: Sequence[str], models: Mapping[str, MachineModel], speed: float = 1.0
    ) -> None:
        """`soils`: names of the ground's soils; `models`: by machine; `speed`: seconds of the machines by ours."""
        self._earth, self._soils, self._speed = earth, soils, speed
        self._recognisers = {name: one for name in models if (one := self._recogniser(name, models[name])) is not None}
        self.filled = False  # a bucket or vessel, since someone set this to False
        self._last: dict[str, _Swing] = {}  # machine -> when it was looked at
        self._missed: dict[str, str] = {}  # machine whose load changed while nobody looked -> carrier that took it

    @property
    def kinds(self) -> dict[str, Kind]:
        """What is counted of whom."""
        return {name: one.kind for name, one in self._recognisers.items()}

    def _recogniser(self, name: str, model: MachineModel) -> Recogniser | None:
        if model.bucket is not None:
            soil = self._earth.grid.soils[0]
            return Recogniser(name, EXCAVATOR, Capacity(model.bucket, soil.repose_slope).heaped)
        return Recogniser(name, CARRIER, model.vessel.heaped) if model.vessel is not None else None

    def take(
        self, machine: str, now: float, angles: Mapping[str, float], place: FramePose, duty: Duty
    ) -> list[Cycle]:  # fmt: skip
        """The cycles that have ended by `now` [s since 1970]; `angles` [rad]. The ground has taken the same before."""
        recogniser, time = self._recognisers.get(machine), now * self._speed
        before = self._last.get(machine)
        if recogniser is None or (before is not None and 0.0 <= time - before.time < STEP - EARLY):
            return []
        angle = angles.get(SWING, 0.0)
        self._last[machine] = _Swing(time, angle)
        body = self._earth.bodies[machine]
        elapsed = time - before.time if before is not None else 0.0
        turn = math.remainder(angle - before.angle, math.tau) / elapsed if before is not None and elapsed > 0.0 else 0.0
        missed = self._missed.pop(machine, None)
        load = load_of(_part(body), self._earth.grid)
        soil = "" if load.kind is None else self._soils[load.kind]
        sample = Sample(
            time, Amount(load.mass, load.bank, load.loose), duty.run, soil, place.x, place.y, duty.moves, duty.stopped,
            swing=turn, cuts=body.digger is not None and body.digger.resistance > 0.0,
            estimated=missed is not None, under=missed or self._under(body),
        )  # fmt: skip
        carried = recogniser.carries
        cycles = [self._dated(one) for one in recogniser.take(sample)]
        self.filled = self.filled or (recogniser.carries and not carried)
        return cycles

    def state(self) -> str:
        """Everything that it remembers, as JSON."""
        return json.dumps({name: one.state() for name, one in self._recognisers.items()})

    def restore(self, state: str, loads: bool) -> None:
        """Go on from a kept state; machines that have joined since begin anew.

        `loads`: whether the loads are those of that time; if not, only the numbers of cycles go on.

        Raises:
            ValueError: it is none.
        """
        found: Any = json.loads(state)
        for name, recogniser in self._recognisers.items():
            if name in found:
                recogniser.restore(found[name])
                if not loads:
                    recogniser.forget()

    def missed(self, machine: str, into: str) -> None:
        """Note that a load was estimated over a time in which nobody looked, and the carrier that took it, if any."""
        self._missed[machine] = into
        if into:
            self._missed.setdefault(into, "")

    @property
    def seen(self) -> float | None:
        """When a machine that a run holds was looked at last [s since 1970]; None: no run holds one."""
        times = [one.seen / self._speed for one in self._recognisers.values() if one.seen is not None]
        return max(times, default=None)

    def number_from(self, first: int) -> None:
        """Give the next cycles of all machines this number: nobody knows which ones were used."""
        for recogniser in self._recognisers.values():
            recogniser.number_from(first)

    def _under(self, body: Body) -> str:
        """The carrier below a bucket."""
        if body.digger is None or "digger" not in body.places:
            return ""
        lip = body.digger.lip(body.places["digger"])
        haulers = ((name, one.hauler) for name, one in self._earth.bodies.items() if one.hauler is not None)
        return next((name for name, hauler in haulers if hauler.below(lip) > 0.0), "")

    def _dated(self, cycle: Cycle) -> Cycle:
        end = datetime.fromtimestamp(cycle.ended_at.timestamp() / self._speed, timezone.utc)
        return cycle.model_copy(update={"begun_at": end - (cycle.ended_at - cycle.begun_at), "ended_at": end})


def _part(body: Body) -> Digger | Hauler:
    part = body.digger or body.hauler
    assert part is not None
    return part
