"""Kinematics against the published vectors, and against themselves."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_reason.reason import Reason
from tms_rp.kinds.backhoe.linkage import ArmAngles, Linkage, Tip, wrap
from tms_rp.reasons import TooFar, TooNear, TooNearAxis

LINKAGE = Linkage.of(parse(CONFIGS / "machines" / "zx200.yaml", MachineModel).geometry)

FORWARD = [  # joints -> x, y, z, theta_w
    ((0, 0, 0, 0), (10.434901, -0.087077, 1.957291, 0)),
    ((0, -0.5, 1.5, 0), (7.697163, -0.087077, 0.919224, 1.0)),
    ((-1.571, -1.047, 2.443, -0.524), (0.054165, -4.594218, 2.806589, 0.872)),
    ((0, 0, 1.65806, 0), (5.595450, -0.087077, -2.477261, 1.65806)),
    ((0.5, -0.6, 1.8, 0.9), (4.650506, 2.387215, 1.104871, 2.1)),
    ((0, -0.1, 0.594, -0.622), (10.048454, -0.087077, 1.350501, -0.128)),
    ((0, -1.137, 2.687, 2.372), (1.659494, -0.087077, 5.292231, 3.922)),
]

INVERSE = [  # x, y, z, theta_w -> joints
    ((1.2068, -5.5729, 2.7381, math.pi), (-1.365581, -0.517532, 1.288476, 2.370648)),
    ((6.5003, 5.2609, 2.5797, 0.5), (0.698151, -0.628425, 1.368710, -0.240285)),
    ((5.5003, 4.2609, 1.5797, math.pi / 2), (0.680273, -0.609795, 1.398592, 0.782000)),
    ((6.3724, -0.0869, 1.3456, math.pi / 2), (0.000028, -0.646500, 1.659780, 0.557516)),
    ((4.5630998611, -0.0995519981, 3.8403999805, 3.0), (-0.002800, -0.837315, 1.646905, 2.190410)),
    ((6.0, 0.0, 0.0, 1.2), (0.014778, -0.436543, 2.014228, -0.377684)),
    ((7.0, -2.0, -0.5, 1.4), (-0.270469, -0.300711, 1.412891, 0.287820)),
    ((0.0798115209, -4.7382431030, 0.1016051769, 0.0), (-1.565542, 0.137885, 2.620858, -2.758743)),
]

angle = st.floats(-math.pi, math.pi)


@pytest.mark.parametrize(("joints", "tip"), FORWARD)
def test_forward(joints: tuple[float, ...], tip: tuple[float, ...]) -> None:
    assert LINKAGE.tip(ArmAngles(*joints)) == pytest.approx(tip, abs=1.5e-6)


@pytest.mark.parametrize(("tip", "joints"), INVERSE)
def test_inverse(tip: tuple[float, ...], joints: tuple[float, ...]) -> None:
    assert LINKAGE.joints(Tip(*tip)) == pytest.approx(joints, abs=1.5e-6)


@given(angle, st.floats(-1.137, -0.1), st.floats(0.594, 2.687), st.floats(-0.622, 2.372))
def test_inverse_of_forward_is_the_same_pose(swing: float, boom: float, arm: float, bucket: float) -> None:
    pose = ArmAngles(swing, boom, arm, bucket)
    found = LINKAGE.joints(LINKAGE.tip(pose))
    assert isinstance(found, ArmAngles)
    assert wrap(found.swing - swing) == pytest.approx(0, abs=1e-9)
    assert found[1:] == pytest.approx(pose[1:], abs=1e-9)


@given(st.floats(-12, 12), st.floats(-12, 12), st.floats(-6, 12), angle)
def test_forward_of_inverse_is_the_same_point(x: float, y: float, z: float, theta_w: float) -> None:
    asked = Tip(x, y, z, theta_w)
    pose = LINKAGE.joints(asked)
    if not isinstance(pose, ArmAngles):
        assert isinstance(pose, (TooFar, TooNear, TooNearAxis))
        return
    assert LINKAGE.tip(pose) == pytest.approx(asked, abs=1e-7)
    assert -math.pi < pose.swing <= math.pi


@pytest.mark.parametrize(
    ("tip", "kind", "missing"),
    [
        (Tip(20.0, 0.0, 1.0, 0.0), TooFar, 9.590),
        (Tip(2.0, 0.0, 2.0, 0.0), TooNear, 2.648),
        (Tip(0.10787, -0.034301, 2.0, 0.0), TooNearAxis, 0.053),
    ],
)
def test_out_of_reach_says_by_how_much(tip: Tip, kind: type[Reason], missing: float) -> None:
    said = LINKAGE.joints(tip)
    assert isinstance(said, Reason) and type(said) is kind
    assert said.args["missing"] == pytest.approx(missing, abs=5e-4)


@given(st.floats(-50, 50))
def test_wrap_keeps_the_direction_in_one_turn(value: float) -> None:
    assert -math.pi < wrap(value) <= math.pi
    assert math.cos(wrap(value) - value) == pytest.approx(1)


def test_wrap_of_half_a_turn_is_positive() -> None:
    assert wrap(-math.pi) == math.pi
