"""Recordings as the API asks tms:db for them."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from tms_msg_db.srv import ReadRecording

from tms_machine import stamps
from tms_machine.asking import ask
from tms_ros.node import Ros
from tms_ur.recording_models import Recording, Series

SERVICE = "/tms/db/read_recording"
LIMIT = 15.0  # s for an answer: a shift has thousands of pieces
LAST_SECOND = 2**31 - 1.0  # of builtin_interfaces/Time
DIGITS = 4  # 0.1 mm, 0.1 mrad


@dataclass(frozen=True)
class Asked:
    """Which part of a recording; without a run, from `begin` to `end`."""

    run_id: str = ""
    begin: float = 0.0  # s since 1970
    end: float = 0.0  # s since 1970; 0: now
    machine: str = ""  # empty: all
    points: int = 0  # of a series at most; 0: as many as tms:db thinks fit


def recording(ros: Ros, asked: Asked) -> Recording:
    """What machines told.

    Raises:
        TmsError: RUN_MISSING, or tms:db is away or refuses.
    """
    request = ReadRecording.Request(
        run_id=asked.run_id,
        begin=stamps.time(asked.begin),
        end=stamps.time(asked.end),
        machine=asked.machine,
        points=asked.points,
    )
    return Recording(series=[_series(one) for one in ask(ros, ReadRecording, SERVICE, request, LIMIT).series])


def _series(told: Any) -> Series:
    rows = np.round(np.array(told.values).reshape(len(told.times), len(told.names)), DIGITS)
    return Series(
        machine=told.machine, kind=told.kind, names=list(told.names), times=np.round(told.times, 3).tolist(),
        values=rows.T.tolist(),
    )  # fmt: skip
