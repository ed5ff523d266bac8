"""Limits of joint angles in records, checked when a person enters them."""

from collections.abc import Mapping
from typing import Any

from tms_config.models import MachineModel
from tms_reason.errors import TmsError
from tms_ur.reasons import AngleUnfit


def check_angles(model: MachineModel, values: Mapping[str, Any]) -> None:
    """Compare the fields that are named as joints of the machine, rad, with the limits of its model.

    Raises:
        TmsError: an angle that the joint cannot have; whatever subtask used the record, its gateway would refuse it.
    """
    for name in model.joints.keys() & values.keys():
        why = model.joints[name].violation(values[name]) if isinstance(values[name], int | float) else None
        if why is not None:
            raise TmsError(AngleUnfit(name, why))
