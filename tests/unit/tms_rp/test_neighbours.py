"""Where other machines stand."""

from types import SimpleNamespace
from typing import Any

import numpy as np
from geometry_msgs.msg import TransformStamped
from tf2_msgs.msg import TFMessage

from tms_rp.neighbours import Neighbours


def seen(x: float) -> TFMessage:
    one = TransformStamped(child_frame_id="ic120_tf/base_link")
    one.header.frame_id = "map"
    one.transform.translation.x, one.transform.rotation.w = x, 1.0
    return TFMessage(transforms=[one])


def test_a_place_that_is_not_a_number_leaves_the_machine_where_it_was() -> None:
    made: Any = Neighbours.__new__(Neighbours)
    made._frames, made._places, made._own = {"ic120_tf/base_link": "ic120"}, {"zx200": np.eye(4)}, "zx200"
    footprint = {"body": object()}
    made._site = SimpleNamespace(model_of=lambda _: SimpleNamespace(footprint=footprint))
    made._news = lambda: [seen(7.0), seen(float("nan")), seen(float("inf"))]
    (obstacle,) = made.obstacles()
    assert obstacle.place[0, 3] == 7.0
