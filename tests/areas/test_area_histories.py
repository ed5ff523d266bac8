"""Some seeds of the histories of machines between areas; `python -m areas.run` tries thousands."""

import pytest

from areas import people
from areas.history import run
from tms_areas.guard import Guard, Verdict
from tms_areas.intruders import Danger, Intruders

SEEDS = range(12)
WALKS = range(6)


@pytest.mark.parametrize("seed", SEEDS)
def test_no_machine_is_ever_where_it_must_not_be_or_drives_blind(seed: int) -> None:
    assert run(seed).violation == ""


@pytest.mark.parametrize("seed", SEEDS)
def test_no_machine_that_dashes_at_a_border_crosses_it(seed: int) -> None:
    assert run(seed, dash=True).violation == ""


def test_without_the_law_some_of_them_would_be(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Guard, "look", lambda *_, **__: Verdict())
    assert any(run(seed, dash=True).crossed is not None for seed in SEEDS)


@pytest.mark.parametrize("seed", WALKS)
def test_nothing_moves_among_people(seed: int) -> None:
    assert people.run(seed).moved == ""


def test_without_a_look_at_people_something_would(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Intruders, "look", lambda *_: Danger())
    assert any(people.run(seed).moved for seed in WALKS)
