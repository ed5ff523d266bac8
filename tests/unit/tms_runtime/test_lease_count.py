"""How many publishers of a leased topic are asserted, as DDS tells it to a reader that may have missed some news."""

from types import SimpleNamespace

import pytest

from tms_runtime.leases import _Count

Numbers = tuple[int, int]


def event(alive: int, not_alive: int) -> SimpleNamespace:
    return SimpleNamespace(alive_count=alive, not_alive_count=not_alive)


@pytest.mark.parametrize(
    ("events", "reported"),
    [
        ([(1, 0), (0, 1), (1, 0), (0, 0)], [(1, 0), (0, 1), (1, 0), (0, 0)]),  # killed in the end
        ([None, (-1, 1), (0, 0), (-1, 1), (-1, 0)], [(1, 0), (0, 1), (1, 0), (0, 1), (0, 0)]),  # its begin was missed
        ([None, (1, 0), (0, 1)], [(1, 0), (2, 0), (1, 1)]),  # and a successor comes before it is lost
        ([(-1, 1), (0, 0)], [(0, 1), (1, 0)]),  # lost before anybody noticed
        ([None, (0, -1)], [(1, 0), (0, 0)]),  # its end was missed as well
        ([(1, 0), None], [(1, 0)]),
    ],
)
def test_what_was_missed_is_made_up(events: list[Numbers | None], reported: list[Numbers]) -> None:
    seen: list[Numbers] = []
    count = _Count(lambda *numbers: seen.append(numbers))
    for one in events:
        count.made_up() if one is None else count.reported(event(*one))
    assert seen == reported
