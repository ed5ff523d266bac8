"""The trials: kinds of stop x faults of the machine, dealt to the machines by a seed. Pure logic."""

import math
import random
from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Any

RC, RP, MC, SUBTASK = "rc", "rp", "mc", "subtask"  # of the machine that is hit
TS, BRIDGE = "tms:ts", "tms:if"
BYSTANDERS = ("tms:db", "tms:sp", "tms:ur", "tms:host", "tms:store")  # no motion depends on them
WAVES, QUICK_WAVES = 16, 2  # of stops that concern one machine, a round
DELAY = (0.05, 1.6)  # s from the begin of a machine's goal to the hit
AROUND = (-0.6, 0.5)  # s from the hit to the moment at which a fault is switched on


class How(Enum):
    """The way of a hit."""

    CANCEL = "cancel"  # cancels the machine's run
    SOFTWARE = "software stop"
    KILL = "kill"
    FREEZE = "freeze"
    POWER = "power cut"
    CUT = "connection of the simulator lost"
    PAUSE = "simulator paused"
    RESTART = "simulator restarted"


@dataclass(frozen=True)
class StopScenario:
    """One kind of stop."""

    how: How
    processes: tuple[str, ...] = ()
    shared: bool = False  # hits all machines at once
    moves: bool = True  # the motion depends on the hit process; else the run is cancelled a moment later
    covered: bool = True  # a gateway or the host agent is left and can stop the machine
    latches: bool = False  # no machine may move afterwards until a person has re-armed it

    @property
    def own(self) -> bool:
        """Whether it concerns one machine alone."""
        return self.moves and not self.shared

    @property
    def name(self) -> str:
        """The name of the stop for people."""
        return " ".join([self.how.value, *(["+".join(self.processes)] if self.processes else [])])


@dataclass(frozen=True)
class Trial:
    """One stop of one machine."""

    machine: str
    stop: StopScenario
    fault: str
    fault_at: float  # s from the hit
    delay: float  # s from the begin of a motion to the hit; a hit of all machines uses the first trial's


BOTH = (How.KILL, How.FREEZE)
TROUBLES = (How.CUT, How.PAUSE, How.RESTART)  # of the simulator
SINGLE = (
    StopScenario(How.CANCEL),
    StopScenario(How.SOFTWARE, latches=True),
    *(StopScenario(how, (process,)) for how in BOTH for process in (SUBTASK, RP, RC)),
)
BESIDE = tuple(tuple(StopScenario(how, (process,), moves=False) for process in BYSTANDERS) for how in BOTH)
SHARED = (
    *(StopScenario(how, (TS,), shared=True, latches=True) for how in BOTH),
    *(StopScenario(how, (RC, TS), shared=True, latches=how is How.KILL) for how in BOTH),
    *(StopScenario(how, (RC, TS, RP, SUBTASK), shared=True, latches=how is How.KILL) for how in BOTH),
    StopScenario(How.KILL, (RC, "tms:host"), shared=True, covered=False),
    StopScenario(How.POWER, shared=True, covered=False, latches=True),
)
NONE = "none"
LIES: Mapping[str, Mapping[str, Any]] = {  # faults of the reports; the motion has no fault
    "zero_velocity": {"zero_velocity": True},
    "frozen_stamp": {"frozen_stamp": True},
    "replay": {"replay": True},
    "mute": {"mute": True},  # a joint of the machine: see `fault_of`
    "second_publisher": {"second_publisher": True},
    "jump": {"jump": 0.5},  # rad, m
    "nan": {"nan": True},
    "back_in_time": {"back_in_time": 5.0},  # s
}
COAST = 3.0  # s
UNKIND: Mapping[str, Mapping[str, Any]] = {  # faults of the motion
    "coast": {"coast": COAST},
    "dead_time": {"dead_time": 0.6},  # s
    "creep": {"creep": 0.05},  # rad/s, m/s
    "ignore_cancel": {"ignore_cancel": True},
    "ignore_emg_stop": {"ignore_emg_stop": True},
    "drift": {"drift": 0.05},  # rad/s, m/s
    "stall": {"stall": 1.0},  # s
    "late": {"late": 0.5},  # s
}
COASTING: Mapping[str, Mapping[str, Any]] = {  # faults that have once caused false receipts
    f"coast+{name}": {"coast": COAST, **lie} for name, lie in LIES.items()
}
FAULTS: Mapping[str, Mapping[str, Any]] = {NONE: {}, **LIES, **UNKIND, **COASTING}
IN_ORDER = (NONE, *LIES)  # the machine moves as commanded


@dataclass(frozen=True)
class Kinds:
    """What a site can be drilled with."""

    single: tuple[StopScenario, ...]  # concern one machine
    shared: tuple[StopScenario, ...]
    faults: tuple[str, ...] = (NONE,)
    beside: tuple[tuple[StopScenario, ...], ...] = BESIDE
    delay: tuple[float, float] = DELAY

    @property
    def stops(self) -> dict[str, StopScenario]:
        """All kinds of stop by name."""
        return {
            stop.name: stop for stop in (*self.single, *(stop for stops in self.beside for stop in stops), *self.shared)
        }


STAND_INS = Kinds(SINGLE, SHARED, tuple(FAULTS))
# No gateway can stop the tracks of OperaSim-PhysX while it is not connected: they go on by their last command.
OPERASIM = Kinds(
    (*SINGLE, *(StopScenario(how, (MC,)) for how in BOTH)),
    (
        *SHARED,
        *(StopScenario(how, shared=True, covered=False, latches=how is not How.PAUSE) for how in TROUBLES),
        *(StopScenario(how, (BRIDGE,), shared=True, covered=False) for how in BOTH),
    ),
    delay=(0.05, 3.5),  # its joints begin to move after their dead time
)
STOPS = STAND_INS.stops | OPERASIM.stops
OFTEN = 3  # trials of each stop without a fault, for one trial with each fault


def fault_of(name: str, joints: Sequence[str]) -> dict[str, Any]:
    """The fault for a stand-in (tms_config.site_file.Fault)."""
    fault = dict(FAULTS[name])
    return {**fault, "mute": [joints[0]]} if "mute" in fault else fault


def plan(
    seed: int, planners: Mapping[str, bool], rounds: int, quick: bool, kinds: Kinds = STAND_INS
) -> list[list[Trial]]:
    """Waves of one trial a machine. `planners`: each machine and whether it has a planner (rp) of its own."""
    dealer = _Dealer(seed, planners, kinds)
    single = max(QUICK_WAVES, math.ceil(len(kinds.single) / len(planners))) if quick else WAVES
    waves = []
    for _ in range(rounds):
        round_ = [dealer.mixed([stop] * len(planners)) for stop in kinds.shared]
        # One bystander for each machine; further machines are cancelled.
        for stops in kinds.beside:
            parts = [stops[at : at + len(planners)] for at in range(0, len(stops), len(planners))]
            round_ += [dealer.mixed([*part, *[SINGLE[0]] * len(planners)]) for part in parts]
        round_ += [dealer.single() for _ in range(single)]
        dealer.dice.shuffle(round_)
        waves += round_
    return waves


def plan_only(
    seed: int, planners: Mapping[str, bool], name: str, waves: int, kinds: Kinds = STAND_INS
) -> list[list[Trial]]:
    """Waves of one kind of stop; a machine without a planner of its own is cancelled where that is hit alone."""
    dealer, stop = _Dealer(seed, planners, kinds), kinds.stops[name]
    stops = [SINGLE[0] if stop.processes == (RP,) and not planner else stop for planner in planners.values()]
    return [dealer.mixed(stops) for _ in range(waves)]


class _Dealer:
    """Two decks of pairs; each is dealt completely before it begins again."""

    def __init__(self, seed: int, planners: Mapping[str, bool], kinds: Kinds) -> None:
        self.dice, self._planners, self._delay = random.Random(seed), planners, kinds.delay
        pairs = [(stop, fault) for stop in kinds.single for fault in [*kinds.faults, *[NONE] * (OFTEN - 1)]]
        self.dice.shuffle(pairs)
        first = {stop: (stop, fault) for stop, fault in pairs}  # each stop early, for a short drill
        self._pairs = deque([*first.values(), *(pair for pair in pairs if pair not in first.values())])
        faults = [name for name in kinds.faults if name != NONE] or [NONE]
        self.dice.shuffle(faults)
        self._faults = deque(faults)

    def single(self) -> list[Trial]:
        """For each machine, the next pair that is possible for it."""
        return [self._trial(name, *self._next(planner)) for name, planner in self._planners.items()]

    def mixed(self, stops: Sequence[StopScenario]) -> list[Trial]:
        """Trials of given stops; every second machine has no fault, since figures are measured there."""
        first = self.dice.randrange(2)
        return [
            self._trial(machine, stops[number], NONE if number % 2 == first else self._fault())
            for number, machine in enumerate(self._planners)
        ]

    def _next(self, planner: bool) -> tuple[StopScenario, str]:
        pair = next(pair for pair in self._pairs if planner or RP not in pair[0].processes)
        self._pairs.remove(pair)
        self._pairs.append(pair)
        return pair

    def _fault(self) -> str:
        self._faults.rotate(-1)
        return self._faults[-1]

    def _trial(self, machine: str, stop: StopScenario, fault: str) -> Trial:
        return Trial(machine, stop, fault, self.dice.uniform(*AROUND), self.dice.uniform(*self._delay))
