"""Numbers among the values of records."""

import math
from typing import TypeGuard


def finite(value: object) -> TypeGuard[float]:
    """Whether a value is a number with which one can reckon."""
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)
