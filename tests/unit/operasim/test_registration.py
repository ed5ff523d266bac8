"""Which topics the stand-in of OperaSim-PhysX registers, in which order."""

import random

import pytest

from operasim import model
from operasim.registration import Registration, registrations

SETS = {
    name: {one: model.machine(placed.model) for one, placed in model.scene(name).machines.items()}
    for name in model.scenes()
}


def topics(found: list[Registration]) -> list[str]:
    return [one.topic for one in found]


def test_the_shipped_scenes() -> None:
    assert list(SETS["SimpleScene"]) == ["zx200", "zx120", "c30r", "ic120"]
    assert list(SETS["SampleScene"]) == ["mst110cr"]


def test_zx200_has_all_its_topics() -> None:
    found = registrations({"zx200": model.machine("zx200")}, random.Random(1))
    first = {(one.topic, one.type, one.publish) for one in found.first}
    assert first == {
        ("/tf", "tf2_msgs/TFMessage", False), ("clock", "rosgraph_msgs/Clock", True),
        ("zx200/front_cmd", "com3_msgs/JointCmd", False), ("zx200/emg_stop", "std_msgs/Bool", False),
        ("/zx200/unity/drive_params", "std_msgs/Float64MultiArray", False),
        ("zx200/joint_state", "sensor_msgs/JointState", True),
        ("zx200/base_link/pose", "geometry_msgs/PoseStamped", True),
        ("move_group/fake_controller_joint_states", "sensor_msgs/JointState", False),
        ("zx200/tracks/cmd_vel", "geometry_msgs/Twist", False), ("zx200/track_cmd", "com3_msgs/JointCmd", False),
        ("zx200/odom", "nav_msgs/Odometry", True),
    }  # fmt: skip
    assert [(one.topic, one.type, one.publish) for one in found.late] == [
        (f"zx200/{joint}/cmd", "std_msgs/Float64", False) for joint in ("swing", "boom", "arm", "bucket")
    ]


@pytest.mark.parametrize("seed", range(5))
def test_tracks_come_after_all_others_and_joints_last(seed: int) -> None:
    found = registrations(SETS["AllMachines"], random.Random(seed))
    names = topics(found.first)
    legacy = names.index("move_group/fake_controller_joint_states")
    tracks = [i for i, name in enumerate(names) if name.endswith(("cmd_vel", "track_cmd", "odom", "odom_pose"))]
    assert len(tracks) == 15
    assert min(tracks) == legacy + 1
    assert max(tracks) == len(names) - 1
    assert len(names) == len(set(names))
    assert len(found.late) == 4 + 4 + 1 + 1


def test_the_order_of_the_others_follows_the_seed() -> None:
    orders = [topics(registrations(SETS["SimpleScene"], random.Random(seed)).first) for seed in (1, 1, 2)]
    assert orders[0] == orders[1]
    assert orders[0] != orders[2]
    assert sorted(orders[0]) == sorted(orders[2])


def test_a_broken_scene_names_its_file(tmp_path_factory: pytest.TempPathFactory) -> None:
    file = tmp_path_factory.mktemp("scene") / "odd.yaml"
    file.write_text("machines: {zx200: {model: zx200, place: [0, 0, 0], colour: red}}")
    with pytest.raises(model.FileError, match=r"odd\.yaml.*colour"):
        model.scene(str(file))
    with pytest.raises(model.FileError, match="No such file"):
        model.machine("zx999")
