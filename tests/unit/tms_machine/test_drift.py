"""A machine that is not heard may have moved, but not for ever: without its permit it stops."""

import pytest

from tms_config.config import CONFIGS
from tms_config.models import DRIVE, MachineModel
from tms_config.yaml_file import parse
from tms_decision.permit_link import LEASE
from tms_machine.drift import FRESH, drift, moving

TRUCK = parse(CONFIGS / "machines" / "ic120.yaml", MachineModel)


def test_what_was_told_just_now_is_right() -> None:
    assert drift(TRUCK, 0.0) == drift(TRUCK, FRESH) == drift(TRUCK, -float("inf")) == 0.0


def test_it_grows_until_the_machine_must_have_stopped() -> None:
    assert 0 < drift(TRUCK, FRESH + 0.1) < drift(TRUCK, FRESH + 0.5) < drift(TRUCK, 60.0) == drift(TRUCK, 3600.0)
    answer = TRUCK.response[DRIVE]
    assert moving(TRUCK, DRIVE, 60.0, 2.0) == pytest.approx(LEASE + answer.dead_time + answer.lag + 1.0)


def test_what_has_no_drive_stays() -> None:
    assert drift(TRUCK.model_copy(update={"drive": None}), 60.0) == 0.0
    assert moving(TRUCK, "bucket_end_joint", 60.0, 1.0) == 0.0
