"""The plans: each takes a path of the protocol that matters."""

from replay.acts import (
    GATEWAY,
    HOST,
    SCHEDULER,
    SUBTASK,
    Act,
    Answered,
    AskToMove,
    AtOnce,
    BeUnkind,
    Cancel,
    Fault,
    Freeze,
    GiveBack,
    Kill,
    Moves,
    Over,
    Plan,
    Press,
    Rearm,
    Restart,
    Resume,
    StallDisk,
    Start,
    Step,
    Take,
)

ONE = "zx200"
MACHINES = (ONE,)
BEGIN = Step(AtOnce(), 0.5, Start("a", ONE))
REARM = Step(Over("a"), 2.0, Rearm(ONE))  # the button counts as pressed for a second
WORKS = (Step(Answered(), 0.5, Start("b", ONE, ("left",))),)  # a run that shows that all is in order again
UNDER_WAY = 1.0  # s of a motion


def _moves(act: Act, goal: int = 1, seconds: float = UNDER_WAY) -> Step:
    return Step(Moves(ONE, goal), seconds, act)


PLANS = (
    Plan("a run is cancelled", (BEGIN, _moves(Cancel("a"))), Over("a")),
    Plan(
        "a person presses stop, and re-arms",
        (
            BEGIN,
            _moves(Press()),
            Step(Over("a"), 0.5, AskToMove(ONE)),
            Step(Answered(), 0.0, Start("b", ONE)),
            Step(Over("b"), 2.0, Rearm(ONE)),
            Step(Answered(), 0.5, AskToMove(ONE)),
        ),
        Answered(),
    ),
    Plan("the gateway is killed", (BEGIN, _moves(Kill(ONE, (GATEWAY,)))), Over("a")),
    Plan("the gateway is frozen", (BEGIN, _moves(Freeze(ONE, (GATEWAY,), 2.5))), Over("a")),
    Plan(
        "the scheduler is killed, and its run is resumed",
        (
            BEGIN,
            _moves(Kill(ONE, (SCHEDULER,)), goal=2),
            Step(Over("a"), 1.0, Rearm(ONE)),
            Step(Answered(), 1.0, Resume("a")),
        ),
        Over("a"),
    ),
    Plan("the scheduler is frozen", (BEGIN, _moves(Freeze(ONE, (SCHEDULER,), 2.5)), REARM, *WORKS), Over("b")),
    Plan(
        "gateway and scheduler are killed",
        (
            BEGIN,
            _moves(Kill(ONE, (GATEWAY, SCHEDULER))),
            Step(Over("a"), 2.0, Rearm(ONE)),
            Step(Answered(), 1.0, Resume("a")),
        ),
        Over("a"),
    ),
    Plan("a subtask is killed", (BEGIN, _moves(Kill(ONE, (SUBTASK,)))), Over("a")),
    Plan("a subtask is frozen", (BEGIN, _moves(Freeze(ONE, (SUBTASK,), 2.5))), Over("a")),
    Plan("a subtask is restarted", (BEGIN, _moves(Restart(ONE, SUBTASK))), Over("a")),
    Plan(
        "stop is pressed while the gateway is away",
        (BEGIN, _moves(Kill(ONE, (GATEWAY,))), Step(AtOnce(), 0.2, Press()), REARM, *WORKS),
        Over("b"),
    ),
    Plan(
        "stop is pressed between two runs, while gateway and host agent are away",
        (
            Step(AtOnce(), 0.5, Start("a", ONE, ("left",))),
            Step(Over("a"), 0.5, Freeze(ONE, (HOST,), 15.0)),
            Step(AtOnce(), 0.5, Kill(ONE, (GATEWAY,))),
            Step(AtOnce(), 0.0, Press()),
            Step(AtOnce(), 10.0, Rearm(ONE)),
        ),
        Answered(),
    ),
    Plan("the host agent is killed", (BEGIN, _moves(Kill(ONE, (HOST,)))), Over("a")),
    Plan(
        "a machine coasts",
        (BEGIN, _moves(BeUnkind(ONE, Fault.COASTS)), Step(AtOnce(), 0.3, Cancel("a"))),
        Over("a"),
    ),
    Plan(
        "a machine does not obey",
        (
            BEGIN,
            _moves(BeUnkind(ONE, Fault.IGNORES_STOPS), seconds=0.2),
            Step(AtOnce(), 0.2, Press()),
            Step(Over("a"), 1.0, BeUnkind(ONE, None)),
            Step(AtOnce(), 1.0, Rearm(ONE)),
        ),
        Answered(),
    ),
    Plan(
        "a machine repeats its last message",
        (BEGIN, _moves(BeUnkind(ONE, Fault.FROZEN_STAMPS)), Step(Over("a"), 0.5, Rearm(ONE))),
        Answered(),
    ),
    Plan(
        "a machine falls silent",
        (
            BEGIN,
            _moves(BeUnkind(ONE, Fault.SILENT)),
            Step(AtOnce(), 0.2, Press()),
            Step(Over("a"), 0.5, Rearm(ONE)),
            Step(Answered(), 0.0, BeUnkind(ONE, None)),
            Step(AtOnce(), 3.0, Rearm(ONE)),
            *WORKS,
        ),
        Over("b"),
    ),
    Plan(
        "two want one machine",
        (BEGIN, _moves(Start("b", ONE)), Step(Over("b"), 0.0, AskToMove(ONE)), Step(Answered(), 0.0, Take(ONE))),
        Over("a"),
    ),
    Plan(
        "a person takes the machine",
        (
            Step(AtOnce(), 0.5, Take(ONE)),
            Step(Answered(), 0.5, Start("a", ONE)),
            Step(Over("a"), 0.5, AskToMove(ONE)),
            Step(Answered(), 0.5, GiveBack(ONE)),
            *WORKS,
        ),
        Over("b"),
    ),
    Plan(
        "the disk stalls while a run is cancelled",
        (BEGIN, _moves(StallDisk(2.0)), Step(AtOnce(), 0.2, Cancel("a"))),
        Over("a"),
    ),
)
