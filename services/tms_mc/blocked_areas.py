"""Areas that nobody drives into: the shared record `blocked_areas` of the database.

Each of its fields is an area, by its name: the corners of a polygon in the map, x and y in turn [m].
"""

from collections.abc import Mapping

from tms_control.ground import Body
from tms_control.reasons import BlockedArea
from tms_machine.reasons import BadRecord
from tms_machine.values import Value
from tms_mc.numbers import finite
from tms_mc.reasons import AreaUnfit
from tms_reason.errors import SubtaskFailed

RECORD = "blocked_areas"
LEAST, MOST = 3, 50  # corners: three large areas of so many make a search of four seconds


def areas(values: Mapping[str, Value]) -> list[Body]:
    """The areas of the record.

    Raises:
        SubtaskFailed: BadRecord: nobody knows what is blocked.
    """
    return [Body(BlockedArea(name), _corners(name, value)) for name, value in values.items()]


def _corners(name: str, value: Value) -> tuple[tuple[float, float], ...]:
    numbers = [float(one) for one in value if finite(one)] if isinstance(value, list) else []
    complete = isinstance(value, list) and len(numbers) == len(value) and len(numbers) % 2 == 0
    if not complete or not LEAST <= len(numbers) // 2 <= MOST:
        raise SubtaskFailed(BadRecord(RECORD, AreaUnfit(name, LEAST, MOST)))
    return tuple(zip(numbers[::2], numbers[1::2], strict=True))
