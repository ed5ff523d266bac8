"""Every excavator of configs/: kinematics there and back, and the zx120's lengths as published."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.yaml_file import parse
from tms_rp.kinds.backhoe.linkage import ArmAngles, Linkage, wrap

EXCAVATORS = {
    path.stem: model
    for path in sorted((CONFIGS / "machines").glob("*.yaml"))
    if (model := parse(path, MachineModel)).planner == "backhoe"
}
share = st.floats(0.01, 0.99)


@pytest.mark.parametrize("name", EXCAVATORS)
@given(swing=st.floats(-3.1, 3.1), boom=share, arm=share, bucket=share)
def test_there_and_back(name: str, swing: float, boom: float, arm: float, bucket: float) -> None:
    model = EXCAVATORS[name]
    linkage = Linkage.of(model.geometry)
    angles = []
    for joint, part in zip(("boom_joint", "arm_joint", "bucket_joint"), (boom, arm, bucket), strict=True):
        limits = model.joints[joint]
        assert limits.min is not None and limits.max is not None
        angles.append(limits.min + part * (limits.max - limits.min))
    tip = linkage.tip(ArmAngles(swing, *angles))
    out = (tip.x - linkage.axis[0]) * math.cos(swing) + (tip.y - linkage.axis[1]) * math.sin(swing)
    if out < 0.5:  # the tip is behind the swing axis: the other way round reaches it, too
        return
    back = linkage.joints(tip)
    assert isinstance(back, ArmAngles)
    assert [wrap(a - b) for a, b in zip(back, (swing, *angles), strict=True)] == pytest.approx([0, 0, 0, 0], abs=1e-6)


def test_the_zx120_stretched_out() -> None:
    linkage = Linkage.of(EXCAVATORS["zx120"].geometry)
    assert linkage.lengths == pytest.approx((4.6, 2.519, 1.23))
    assert linkage.offsets == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)
    tip = linkage.tip(ArmAngles(0.0, 0.0, 0.0, 0.0))
    assert tip == pytest.approx((0.14 + 4.6 + 2.519 + 1.23, -0.16443, 1.424, 0.0), abs=1e-9)
