"""Roads that carriers follow: the shared record `roads` of the database.

Each of its fields is a road, by its name: the names of records in turn, each with the place, or the places, of a part
of it: `x` and `y` [m, map], as numbers or lists. Sections of roads of the C++ system are such records.
"""

from collections.abc import Callable, Mapping

from tms_control.roads import MOST, Place, Roads, count
from tms_machine.reasons import BadRecord
from tms_machine.values import Value
from tms_mc.numbers import finite
from tms_mc.reasons import ManyPlaces, RoadShort, RoadUnfit, SectionUnfit
from tms_reason.errors import SubtaskFailed
from tms_reason.reason import Reason

RECORD = "roads"


def roads(values: Mapping[str, Value], read: Callable[[str], Mapping[str, Value] | None]) -> Roads:
    """The roads of the record; `read` gives the values of a section, None where there is none.

    Raises:
        SubtaskFailed: BadRecord; and whatever `read` raises.
    """
    lines = tuple(_line(name, value, read) for name, value in values.items())
    if (places := count(lines)) > MOST:
        raise _bad(ManyPlaces(places, MOST))
    return Roads(lines)


def _line(name: str, value: Value, read: Callable[[str], Mapping[str, Value] | None]) -> tuple[Place, ...]:
    if not isinstance(value, list) or not value:
        raise _bad(RoadUnfit(name))
    places = list[Place]()
    for section in value:
        if not isinstance(section, str):
            raise _bad(RoadUnfit(name))
        places += [place for place in _places(section, read(section)) if place not in places[-1:]]
    if len(places) < 2:
        raise _bad(RoadShort(name))
    return tuple(places)


def _places(section: str, values: Mapping[str, Value] | None) -> list[Place]:
    x, y = ([one] if not isinstance(one, list) else one for one in map((values or {}).get, ("x", "y")))
    numbers = [[float(one) for one in told if finite(one)] for told in (x, y)]
    if not numbers[0] or [len(x), len(y)] != [len(numbers[0])] * 2 or len(numbers[1]) != len(y):
        raise _bad(SectionUnfit(section))
    return list(zip(*numbers, strict=True))


def _bad(why: Reason) -> SubtaskFailed:
    return SubtaskFailed(BadRecord(RECORD, why))
