"""Heights as messages, and back."""

import numpy as np
import pytest
from tms_msg_ground.msg import HeightPatch

from tms_soil.patches import heights, patch
from tms_soil.surface import Heights


def test_they_come_back() -> None:
    told = Heights(-3.5, 2.0, 0.1, np.array([[1.0, 2.0, np.nan], [4.0, 5.0, 6.0]]))
    message = patch(told, 7)
    assert (message.serial, message.rows, message.columns, message.header.frame_id) == (7, 2, 3, "map")
    found = heights(message)
    assert (found.x0, found.y0, found.cell) == (told.x0, told.y0, told.cell)
    assert np.array_equal(found.z, told.z, equal_nan=True)


@pytest.mark.parametrize("wrong", [
    {"rows": 3}, {"rows": 0, "heights": []}, {"cell": 0.0}, {"cell": float("nan")}, {"x0": float("inf")},
])  # fmt: skip
def test_what_is_no_rectangle_of_heights_is_refused(wrong: dict[str, object]) -> None:
    message = HeightPatch(**{"cell": 0.1, "rows": 2, "columns": 2, "heights": [0.0] * 4} | wrong)
    with pytest.raises(ValueError):
        heights(message)
