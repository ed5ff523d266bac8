"""The bodies of bucket and arm, and when the bucket holds soil."""

import itertools
import math
from collections.abc import Sequence

import numpy as np

from tms_config.models import Box, MachineModel
from tms_control.links import Array, Links, box_place
from tms_rp.kinds.backhoe.linkage import ArmAngles

LEVEL = (
    math.pi
)  # rad, theta_w with which the teeth are as high as the pin: the opening of zx200's bucket is level at 3.09
TILT = 0.6  # rad from there while it swings with soil: 34 degrees, the angle of repose of dry sand
EMPTIED = 1.3  # rad from there at which no soil stays: angle of repose and 45 degrees for the inner walls


class Body:
    """The box round a link of the arm; that of the bucket holds a heap of 1:1 above the opening, too."""

    def __init__(self, model: MachineModel, joint: str) -> None:
        """`joint`: the one that moves the link."""
        self.link = model.geometry[joint].child
        self._names, self._links, box = tuple(model.joints), Links(model), model.shapes[self.link]
        half = [(high - low) / 2 for low, high in zip(box.min, box.max, strict=True)]
        ends = itertools.product(*((-side, side) for side in half))
        self._corners = np.array([(*corner, 1.0) for corner in ends]) @ box_place(box).T
        self.half_width = max(-box.min[1], box.max[1])  # m, from the plane of the arm

    def corners(self, *poses: ArmAngles) -> Array:
        """Where its corners are at poses, in base_link [m]: poses x 8 x 3."""
        names = ("swing_joint", "boom_joint", "arm_joint", "bucket_joint")
        angles = [dict(zip(names, pose, strict=True)) for pose in poses]
        whole = np.array([[one.get(name, 0.0) for name in self._names] for one in angles])
        places = self._links.places(whole)[self.link]
        return np.asarray((self._corners @ places.swapaxes(1, 2))[..., :3])

    def lowest(self, pose: ArmAngles) -> float:
        """How high it hangs above the plane on which the tracks stand [m]."""
        return float(self.corners(pose)[..., 2].min())

    def near(self, poses: Sequence[ArmAngles], box: Box, gap: float) -> bool:
        """Whether it may be nearer to a box of base_link than a gap [m] in a pose, by its extents along the axes."""
        corners = self.corners(*poses)
        above = corners.max(axis=1) > np.array(box.min) - gap
        below = corners.min(axis=1) < np.array(box.max) + gap
        return bool((above & below).all(axis=1).any())


def tilt(pose: ArmAngles) -> float:
    """How far the bucket is turned from level [rad]; positive: open."""
    return LEVEL - (pose.boom + pose.arm + pose.bucket)
