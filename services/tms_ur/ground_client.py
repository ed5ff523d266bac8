"""The ground as the API sees it: asked of `tms:ground`, in cells so large that a browser can hold them."""

import math

from tms_msg_ground.srv import GetHeights

from tms_machine.asking import ask
from tms_ros.node import Ros
from tms_ur.ground_models import Ground, ground_of

SERVICE = "/tms/ground/get_heights"
LIMIT = 4.0  # s for an answer
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
