"""Scenes: things that go wrong one after the other, which chance alone brings together too rarely."""

import random
from collections.abc import Sequence

from simulation.plan import (
    QUIET,
    SECONDS,
    Act,
    Cancel,
    ForeignGoal,
    Kill,
    Levers,
    Lie,
    Planned,
    Press,
    Rearm,
    Stall,
    Stranger,
    Take,
    machines,
    passive,
    plan,
)
from simulation.plant import Fault

OFTEN = 0.25  # share of schedules with a scene
LASTS = 6.0  # s, a scene at most

Scene = Sequence[tuple[float, Act]]  # s from its begin, act


def planned(seed: int) -> list[Planned]:
    """All that goes wrong with this seed."""
    return sorted([*plan(seed), *scene(seed)], key=lambda one: one.at)


def scene(seed: int) -> list[Planned]:
    """The scene of this seed, or none."""
    chance = random.Random(f"seldom {seed}")
    if chance.random() >= OFTEN:
        return []
    begin = 3.0 + chance.random() * (SECONDS - QUIET - LASTS)
    unit, found = chance.randrange(machines(seed)), chance.choice(_scenes(chance, passive(seed)))
    return [Planned(begin + after, unit, act) for after, act in found]


def _scenes(chance: random.Random, two_joints: bool) -> list[Scene]:
    press, later = Press(0.2), chance.random()
    lies = [Fault(coast=2.0, mute_joint=True)] if two_joints else [
        Fault(coast=2.0, frozen_stamp=True, zero_velocity=True), Fault(coast=2.0, second_publisher=True)]  # fmt: skip
    stop = chance.choice((press, Cancel()))
    hides = Lie(Fault(coast=2.5, replay=True), 6.0)
    return [
        *([(0.0, Lie(one, 5.0)), (0.2 + later, stop)] for one in lies),  # stopped while it begins to lie
        [(0.0, Lie(chance.choice(lies), 6.0))],
        [(0.0, press), (2.0 + later, Levers(3.0))],  # moved while it is latched
        [(0.0, Kill(("rc",), (1.0 + later,))), (0.3, press)],  # a press that the gateway does not hear
        [(0.0, Take(4.0)), (0.5 + later, ForeignGoal(2.0))],  # a goal while a person drives ...
        [(0.0, Take(5.0)), (0.5, Kill(("rc",), (0.8,))), (3.5 + later, ForeignGoal(2.0))],  # ... and after a restart
        [(0.0, press), (2.5, Rearm()), (2.7 + later, press)],  # between the two steps of a re-arm
        # A motion that nobody saw, which a stranger has cancelled, goes on while no run knows of it.
        [
            (0.0, Kill(("ts",), (7.0,))),
            (2.5, hides),
            (2.8 + later / 2, ForeignGoal(2.0)),
            (3.5 + later / 2, Stranger()),
            (4.5 + later, press),
        ],
        [(0.0, press), (2.4, Stall(2.0, full=False)), (2.5, Rearm()), (2.6 + later, press)],  # while its note waits
    ]
