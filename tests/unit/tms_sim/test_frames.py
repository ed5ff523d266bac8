"""The chain of frames ends where the published forward kinematics says."""

import math

import pytest

from tms_config.config import CONFIGS
from tms_config.models import Border, MachineModel
from tms_config.yaml_file import parse
from tms_machine.geometry import Quaternion, product
from tms_sim.frames import Chain, LinkTransform

MODEL = parse(CONFIGS / "machines" / "zx200.yaml", MachineModel)
NAMES = tuple(MODEL.joints)


def rotate(turn: Quaternion, point: tuple[float, float, float]) -> tuple[float, float, float]:
    x, y, z, w = turn
    rx, ry, rz, _ = product(product(turn, (*point, 0.0)), (-x, -y, -z, w))
    return rx, ry, rz


def tip(frames: list[LinkTransform]) -> tuple[float, ...]:
    """Origin of the last frame in base_link; each parent is the child before it."""
    place, turn = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)
    before = frames[1].parent
    for frame in frames[1:]:
        assert frame.parent == before
        moved = rotate(turn, frame.xyz)
        place = (place[0] + moved[0], place[1] + moved[1], place[2] + moved[2])
        turn, before = product(turn, frame.turn), frame.child
    assert before == "bucket_end_link"
    return place


@pytest.mark.parametrize(
    ("joints", "point"),
    [
        ((0, 0, 0, 0), (10.434901, -0.087077, 1.957291)),
        ((-1.571, -1.047, 2.443, -0.524), (0.054165, -4.594218, 2.806589)),
        ((0.5, -0.6, 1.8, 0.9), (4.650506, 2.387215, 1.104871)),
        ((0, -1.137, 2.687, 2.372), (1.659494, -0.087077, 5.292231)),
    ],
)
def test_tip(joints: tuple[float, ...], point: tuple[float, ...]) -> None:
    frames = Chain(MODEL, Border(frame_prefix="", base_frame="base_link")).frames(
        (0.0, 0.0, 0.0), dict(zip(NAMES, joints, strict=False))
    )
    assert tip(frames) == pytest.approx(point, abs=1.5e-6)


def test_the_base_stands_in_the_map() -> None:
    border = Border(frame_prefix="a/", base_frame="a/base_link")
    base, first, *_ = Chain(MODEL, border).frames((1.0, 2.0, math.pi), {})
    assert base[:3] == ("map", "a/base_link", (1.0, 2.0, 0.0))
    assert base.turn == pytest.approx((0, 0, 1, 0))
    assert (first.parent, first.child) == ("a/base_link", "a/track_link")
