"""Where other machines stand, and what the collision check makes of it."""

from types import SimpleNamespace
from typing import Any

import pytest
import structlog
from geometry_msgs.msg import PoseStamped, TransformStamped
from tf2_msgs.msg import TFMessage

from tms_config.clock import monotonic
from tms_config.config import CONFIGS
from tms_config.models import Border, Box, MachineModel, Source
from tms_config.yaml_file import parse
from tms_proof.reasons import Old, Pose, Unheard
from tms_reason.errors import SubtaskFailed
from tms_ros.topics import Arrival
from tms_rp.neighbours import Neighbours
from tms_rp.reasons import PartOf

BODY = Box(min=(-3.0, -1.3, 0.0), max=(2.0, 1.3, 3.0))
TRUCK = parse(CONFIGS / "machines" / "ic120.yaml", MachineModel).model_copy(
    update={"footprint": {"body": BODY}, "shapes": {}}
)
BASES = {"zx200": "base_link", "ic120": "ic120_tf/base_link"}
POSE = Border(
    pose="base_link/pose",
    sources={"pose": Source(period=0.06, stamps="since_start", frozen_after=5.0, origin="a test")},
)


def at(child: str, x: float, parent: str = "map") -> TransformStamped:
    one = TransformStamped(child_frame_id=child)
    one.header.frame_id = parent
    one.transform.translation.x, one.transform.rotation.w = x, 1.0
    return one


def neighbours(
    *reported: TransformStamped, pose: tuple[float, float] | None = None, own: Border | None = None, alone: bool = False
) -> Neighbours:
    """Those of zx200, who has heard `reported` twice, and its own pose: x [m] and its age [s]."""
    borders = {name: Border(base_frame=frame) for name, frame in BASES.items()} | ({"zx200": own} if own else {})
    if alone:
        del borders["ic120"]
    posed = PoseStamped()
    posed.header.frame_id, posed.pose.orientation.w, posed.pose.position.x = "world", 1.0, pose[0] if pose else 0.0
    site: Any = SimpleNamespace(
        border=borders.__getitem__,
        file=SimpleNamespace(machines=borders),
        model_of=lambda _: TRUCK,
    )
    ros = SimpleNamespace(
        sample=lambda *_: lambda: [TFMessage(transforms=list(reported))],
        sample_arrivals=lambda *_: lambda: [Arrival(posed, monotonic() - pose[1], 1)] if pose else [],
        poll_in_thread=lambda _, step, __: (step(), step()),
        subscribe=lambda *_, **__: None,
    )
    log = structlog.stdlib.get_logger("test")
    return Neighbours(SimpleNamespace(site=site, machine="zx200", log=log, ros=ros))  # type: ignore[arg-type]


def test_the_other_is_seen_from_here_also_through_odom() -> None:
    (obstacle,) = (
        neighbours(at("odom", 2.0), at("base_link", 1.0, "odom"), at("ic120_tf/base_link", 10.0), at("other", 4.0))
        .scene()
        .obstacles
    )
    assert obstacle.name == PartOf("body", "ic120")
    assert obstacle.place[0, 3] == pytest.approx(7.0)


def test_what_was_told_since_the_listening_thread_slept_counts() -> None:
    reported = at("ic120_tf/base_link", 10.0)
    made = neighbours(at("base_link", 0.0), reported)
    reported.transform.translation.x = 3.0  # says the next message
    (obstacle,) = made.scene().obstacles
    assert obstacle.place[0, 3] == 3.0


def test_a_place_that_is_not_a_number_leaves_the_machine_where_it_was() -> None:
    bad = [at("ic120_tf/base_link", value) for value in (float("nan"), float("inf"))]
    (obstacle,) = neighbours(at("base_link", 0.0), at("ic120_tf/base_link", 7.0), *bad).scene().obstacles
    assert obstacle.place[0, 3] == 7.0


def test_who_does_not_know_its_own_place_says_so(caplog: pytest.LogCaptureFixture) -> None:
    assert neighbours(at("ic120_tf/base_link", 7.0)).scene().obstacles == ()
    assert "event=place_unknown target=zx200" in caplog.text


def test_the_other_is_seen_from_the_pose_that_this_machine_tells() -> None:
    made = neighbours(at("ic120_tf/base_link", 10.0), pose=(4.0, 0.0), own=POSE)
    (obstacle,) = made.scene().obstacles
    assert obstacle.place[0, 3] == pytest.approx(6.0) and made.unready() is None


def test_a_machine_whose_pose_is_missing_plans_nothing_beside_others() -> None:
    unheard, old = neighbours(own=POSE), neighbours(at("ic120_tf/base_link", 10.0), pose=(4.0, 60.0), own=POSE)
    assert unheard.unready() == Unheard(Pose(), "/zx200/base_link/pose")
    for made, kind in ((unheard, Unheard), (old, Old)):
        with pytest.raises(SubtaskFailed) as caught:
            made.scene()
        assert isinstance(caught.value.reason, kind)


def test_where_a_machine_stands_does_not_matter_to_it_alone() -> None:
    made = neighbours(own=POSE, alone=True)
    assert made.unready() is None and made.scene().obstacles == ()
