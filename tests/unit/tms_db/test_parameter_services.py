"""What an update of sensing says about its age."""

import math
from datetime import timedelta
from types import SimpleNamespace as Message
from typing import Any

import pytest

from tms_config.clock import utc_now
from tms_db.batches import Update
from tms_db.parameter_services import OLDEST, ParameterServices
from tms_db.record_cache import Head, Key
from tms_machine.values import to_parameters


def taken(age: float) -> timedelta:
    """How old the values of an update are that comes with this age."""
    services: Any = ParameterServices.__new__(ParameterServices)
    services._batches = Message(gone=Message(is_set=lambda: False))
    services._heads = Message(dynamic=lambda key: Head({"_id": 1, "type": "dynamic"}, math.inf))
    updates: dict[Key, Update] = {}
    wanted = Message(values=to_parameters({"x": 1.0}), loose=False, keep=[], age=age, expected=[], source="sp")
    services._take(updates, ("zx200", "p"), wanted)
    stamp = updates["zx200", "p"].updated_at
    assert stamp is not None
    return utc_now() - stamp


@pytest.mark.parametrize(
    ("age", "counts"),
    [(0.0, 0.0), (2.5, 2.5), (-5.0, 0.0), (1e12, OLDEST), (1e300, OLDEST), (math.inf, OLDEST), (math.nan, OLDEST)],
)
def test_any_age_is_taken(age: float, counts: float) -> None:
    assert taken(age).total_seconds() == pytest.approx(counts, abs=1.0)
