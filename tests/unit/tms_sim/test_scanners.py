"""A stand-in of a scanner publishes what it sees of the known ground."""

from types import SimpleNamespace
from typing import Any

import numpy as np
from tms_msg_ground.srv import GetHeights

from tms_config.site_file import Scanner
from tms_sim.scanners import ScannerStandIn
from tms_soil import patches
from tms_soil.scanning import gathered
from tms_soil.surface import Heights
from tms_sp.terrain import points


def scan(ages: np.ndarray, place: tuple[float, float] | None = (0.0, 0.0), code: str = "") -> list[Any]:
    ground = Heights(-6.0, -6.0, 0.1, np.full((120, 120), 2.0))
    answer = GetHeights.Response(ground=patches.patch(ground), ages=patches.numbers(ages), error_code=code)
    told: list[Any] = []
    app: Any = SimpleNamespace(
        ros=SimpleNamespace(
            publisher=lambda *_, **__: SimpleNamespace(publish=told.append), poll_in_thread=lambda *_: None,
            has_service=lambda *_: True, call=lambda *_: answer,
        )
    )  # fmt: skip
    ScannerStandIn(app, "mast", Scanner(range=5.0, noise=0.0), lambda: place, 1).scan()
    return told


def test_it_sees_the_ground_that_is_known() -> None:
    ages = np.full((120, 120), 3.0)
    ages[:, 60:] = np.nan
    (cloud,) = scan(ages)
    assert cloud.header.frame_id == "map"
    found = gathered(points(cloud), 0.1)
    assert np.nanmin(found.z) == np.nanmax(found.z) == 2.0
    x, _ = found.centres
    assert x[np.isfinite(found.z)].max() < 0.0, "the rest is only assumed"
    assert np.isfinite(found.z).sum() > 500


def test_without_a_place_or_beside_the_site_it_says_nothing() -> None:
    known = np.full((120, 120), 3.0)
    assert not scan(known, place=None) and not scan(known, code="NOT_AN_AREA")
