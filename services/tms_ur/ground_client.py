"""The ground as the API sees it: asked of `tms:ground`, in cells so large that a browser can hold them."""

import math
from datetime import datetime

from tms_msg_ground.srv import GetHeights, ReadSnapshot

from tms_machine.asking import ask
from tms_reason.errors import TmsError
from tms_ros.node import Ros
from tms_ur.ground_models import Ground, ground_of, ground_then
from tms_ur.reasons import GroundNotRead

SERVICE = "/tms/ground/get_heights"
LIMIT = 4.0  # s for an answer
KEPT, KEPT_LIMIT = "/tms/db/read_snapshot", 20.0  # s: a ground has megabytes
FINEST, COARSEST = 0.2, 10.0  # m, cells that tms:ground answers with


def ground(ros: Ros, most: int) -> Ground:
    """Heights of the whole site in at most about `most` cells.

    Raises:
        TmsError: `tms:ground` is away, or refuses.
    """
    whole = ask(ros, GetHeights, SERVICE, GetHeights.Request(cell=COARSEST), LIMIT).ground
    side = math.sqrt(whole.rows * whole.columns * COARSEST**2 / most)  # m
    cell = min(COARSEST, max(FINEST, math.ceil(side / FINEST) * FINEST))
    return ground_of(ask(ros, GetHeights, SERVICE, GetHeights.Request(cell=cell), LIMIT))


def ground_at(ros: Ros, time: datetime, most: int) -> Ground:
    """The last ground that the database has kept until a time, in at most about `most` cells.

    Raises:
        TmsError: GROUND_NOT_THERE: none was kept until then; GroundNotRead; or the database is away, or refuses.
    """
    request = ReadSnapshot.Request(snapshot="last", until=time.isoformat())
    answer = ask(ros, ReadSnapshot, KEPT, request, KEPT_LIMIT)
    try:
        return ground_then(answer, most)
    except ValueError as error:
        raise TmsError(GroundNotRead(answer.taken_at, str(error))) from error
