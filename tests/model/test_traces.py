"""Histories of the simulation, and those of a drill, are histories of the model; forged ones are not."""

from typing import Any

import pytest

from model.journals import accepted, is_known
from model.journals import words_of as words_of_trial
from model.traces import Mapping, Reader, known, numbers, words_of
from simulation.plan import Lie, machines, plan
from simulation.schedule import Schedule
from simulation.world import Happened

SEEDS = [seed for seed in range(1, 40) if machines(seed) == 1 and seed % 3][:12]  # one machine, no planner


@pytest.fixture(scope="module")
def reader(tmp_path_factory: pytest.TempPathFactory) -> Reader:
    return Reader(tmp_path_factory.mktemp("reader"))


def history(seed: int) -> list[str]:
    return words_of(Schedule(seed, known(plan(seed))).run().history)


def test_lines_of_a_history_become_words() -> None:
    mapping = Mapping()
    for who, what in (
        ("tms:ts", "run-1-1 is running"), ("tms:ts", "run-1-1 sends 0.0.0 to m0"),
        ("m0:rc", "is asked for goal 101 of Owner(run=100, leaf=1, hop=1)"), ("m0:rc", "sends goal 101"),
        ("m0", "accepts goal 101 for 2.0 s"), ("m0:rc", "is killed"), ("m0:rc", "starts (2)"),
        ("m0:rc", "tells: confirmed=True X None"), ("tms:ts", "run-1-1 is failure"), ("operator", "re-arms"),
    ):  # fmt: skip
        mapping.take(Happened(0.0, who, what))
    assert mapping.words == [
        "BEGINS 1", "SENDS 1", "ACCEPTS 1", "KILLED_GATEWAY 0", "STARTED_GATEWAY 0", "CONFIRMED 0", "OVER 1",
    ]  # fmt: skip
    assert all(word.split()[0] in numbers() for word in mapping.words)


def test_what_the_model_does_not_know_is_left_out_of_a_plan() -> None:
    assert not any(isinstance(one.act, Lie) for seed in SEEDS for one in known(plan(seed)))


@pytest.mark.turns
@pytest.mark.parametrize("seed", SEEDS)
def test_a_history_of_the_simulation_is_one_of_the_model(reader: Reader, seed: int) -> None:
    words = history(seed)
    assert len(words) > 5
    assert reader.accepts(words), f"refused after {reader.read(words)} of {words}"


def test_a_command_after_a_stop_is_refused(reader: Reader) -> None:
    """No goal leaves after a press that the gateway has heard, before a re-arm."""
    begin = ["BEGINS 1", "SENDS 1", "ACCEPTS 1", "PRESSED 0", "CONFIRMED 0", "OVER 1", "BEGINS 2"]
    assert reader.accepts(begin)
    assert reader.accepts([*begin, "ARMS 0", "SENDS 2"])
    assert not reader.accepts([*begin, "SENDS 2"])


def stopped(seed: int) -> list[str]:
    """The history up to the end of a run that a press has ended, if nobody re-arms before."""
    words = history(seed)
    pressed = words[words.index("PRESSED 0") :] if "PRESSED 0" in words else []
    over = next((at for at, word in enumerate(pressed) if word.startswith("OVER")), 0)
    cut = pressed[: over + 1]
    return words[: words.index("PRESSED 0") + over + 1] if over and "ARMS 0" not in cut and "CONFIRMED 0" in cut else []


def test_a_real_history_with_a_forged_command_is_refused(reader: Reader) -> None:
    words = next(filter(None, map(stopped, (seed for seed in range(19, 99) if machines(seed) == 1 and seed % 3))))
    begun = 1 + sum(word.startswith("BEGINS") for word in words)
    assert reader.accepts([*words, f"BEGINS {begun}"])
    assert not reader.accepts([*words, f"BEGINS {begun}", f"SENDS {begun}"])


def test_a_goal_of_an_old_run_is_refused(reader: Reader) -> None:
    begin = ["BEGINS 1", "KILLED_SCHEDULER 0", "CONFIRMED 0", "STARTED_SCHEDULER 0", "ARMS 0", "BEGINS 2"]
    assert reader.accepts([*begin, "SENDS 2", "ACCEPTS 2"])
    assert not reader.accepts([*begin, "SENDS 2", "ACCEPTS 2", "SENDS 1"])


# trials of a drill

RELAY = "m0:swing"


def trial(stop: str, *happened: tuple[float, float, str, str, str], fault: str = "none") -> dict[str, Any]:
    """Times are s; each thing happened between the first and the second, most likely at the second."""
    told = [
        {"first": a, "likely": b, "last": b, "what": what, "who": who, "told": words}
        for a, b, what, who, words in happened
    ]
    return {"machine": "m0", "stop": stop, "fault": fault, "relay": RELAY, "happened": told}


BEGIN = ((0.0, 0.0, "run", "tms:ts", "STATE_RUNNING"), (1.0, 1.0, "accepts", "m0", ""))
KILLED = trial(
    "kill rc", *BEGIN, (2.0, 2.0, "killed", "m0:rc", ""), (2.0, 3.0, "started", "m0:rc", ""),
    (3.5, 5.2, "receipt", "m0", "confirmed"), (5.0, 5.0, "accepts", "m0", ""),
)  # fmt: skip


def test_only_trials_without_liars_and_without_a_planner_of_their_own_are_in_words_of_the_model() -> None:
    assert is_known(KILLED) and is_known(trial("power cut"))
    assert not is_known(trial("kill rc", fault="replay")) and not is_known(trial("freeze rp"))


def test_what_observers_saw_becomes_words() -> None:
    assert [one.word for one in words_of_trial(KILLED)] == [
        "BEGINS 1", "SENDS 1", "ACCEPTS 1", "KILLED_GATEWAY 0", "STARTED_GATEWAY 0", "SENDS 1", "ACCEPTS 1",
        "CONFIRMED 0",
    ]  # fmt: skip


def test_one_order_that_the_times_allow_is_a_history(reader: Reader) -> None:
    """The receipt arrived after the next goal, and left before it."""
    seen = words_of_trial(KILLED)
    read, order = accepted(reader, seen)
    assert read == len(seen) and order.index("CONFIRMED 0") < order.index("SENDS 1", 3)


def test_a_goal_after_the_end_of_its_run_is_refused_in_every_order(reader: Reader) -> None:
    forged = trial(
        "cancel", *BEGIN, (3.0, 3.1, "receipt", "m0", "confirmed"), (3.2, 3.2, "run", "tms:ts", "STATE_CANCELLED"),
        (5.0, 5.0, "accepts", "m0", ""),
    )  # fmt: skip
    seen = words_of_trial(forged)
    assert accepted(reader, seen)[0] < len(seen)
    whole = words_of_trial({**forged, "happened": forged["happened"][:-1]})
    assert accepted(reader, whole)[0] == len(whole)
