"""Some seeds of machines that share places; `python -m areas.run` tries thousands."""

import pytest

from areas.shared import run

SEEDS = range(5)
ROLLING = (787386612, 787387034)  # a place is lost on the way in: nobody wants it and its lease ends, or by a person


@pytest.mark.parametrize("seed", (*SEEDS, *ROLLING))
def test_no_two_machines_in_one_place_and_no_circle_untold(seed: int) -> None:
    found = run(seed)
    assert not found.two_inside and not found.unseen and not found.starved
    assert found.rounds > 0


def test_without_leases_two_would_meet() -> None:
    assert any(run(seed, jealous=False).two_inside for seed in SEEDS)
