"""What a client may publish, hear, call and offer."""

from pathlib import Path

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from tms_config.config import Site, load_site
from tms_if.commands import CommandError, Registration, full_name, parse
from tms_if.names import Allowed, allowed
from tms_reason.errors import ConfigError

SITE = {
    "name": "t", "domain": 1, "backend": "physx",
    "machines": {"zx200": {"model": "zx200"}, "hauler": {"model": "mst110cr"}},
}  # fmt: skip
PUBLISHED = {
    "/zx200/joint_state": "sensor_msgs/JointState", "/zx200/odom": "nav_msgs/Odometry",
    "/zx200/base_link/pose": "geometry_msgs/PoseStamped", "/hauler/joint_states": "sensor_msgs/JointState",
    "/hauler/odom_pose": "nav_msgs/Odometry", "/hauler/global_pose": "nav_msgs/Odometry",
}  # fmt: skip
# Registrations of OperaSim-PhysX's prefabs, as they come: the zx200's, and those of all machines.
PREFAB_HEARS = {
    "zx200/tracks/cmd_vel": "geometry_msgs/Twist", "zx200/track_cmd": "com3_msgs/JointCmd",
    "zx200/front_cmd": "com3_msgs/JointCmd", "zx200/emg_stop": "std_msgs/Bool", "zx200/swing/cmd": "std_msgs/Float64",
    "/zx200/unity/drive_params": "std_msgs/Float64MultiArray", "hauler/rot_dump_cmd": "com3_msgs/JointCmd",
    "move_group/fake_controller_joint_states": "sensor_msgs/JointState", "/tf": "tf2_msgs/TFMessage",
}  # fmt: skip


def site(tmp_path: Path, bridge: object = None, **settings: object) -> Site:
    file = tmp_path / "site.yaml"
    file.write_text(yaml.safe_dump({**SITE, "services": {"if": bridge or {}}, **settings}))
    return load_site(str(file))


@pytest.fixture(scope="module")
def rules(tmp_path_factory: pytest.TempPathFactory) -> Allowed:
    return allowed(site(tmp_path_factory.mktemp("names")))


def test_the_sensor_topics_of_the_machines_and_nothing_else(rules: Allowed) -> None:
    assert rules.published == {name: {kind} for name, kind in PUBLISHED.items()}
    for name, kind in PUBLISHED.items():
        assert rules.publishing(name, kind) is None


@pytest.mark.parametrize(
    "name",
    ["/zx200/goal_pose", "/zx200/upper_arm_controller/joint_trajectory", "/zx200/blade_controller/commands",
     "/bt_navigator/change_state", "/zx200/tracks/cmd_vel", "/zx200/emg_stop", "/zx200/front_cmd", "/zx200/swing/cmd",
     "/tms/stop", "/zx200/rc/state", "/zx200/permit/ts", "/emergency_signal", "/rosout", "/tf", "/tms_sp_change_pose",
     "/zx200/end_effector", "/ic120/odom", "/mst110cr/odom_pose", "/zx200/joint_states",
     "/zx200/navigate_to_pose/_action/feedback"],
)  # fmt: skip
def test_nobody_publishes_what_is_no_sensor(rules: Allowed, name: str) -> None:
    for kind in ("sensor_msgs/JointState", "nav_msgs/Odometry", "std_msgs/Bool"):
        assert rules.publishing(name, kind) == (
            f"{name} is no sensor topic of this site's machines: its messages are left out"
        )


def test_a_topic_keeps_its_type(rules: Allowed) -> None:
    assert rules.publishing("/zx200/odom", "geometry_msgs/PoseStamped") == (
        "/zx200/odom is nav_msgs/Odometry on this site, not geometry_msgs/PoseStamped: it is refused"
    )
    assert "is geometry_msgs/Twist on this site" in str(rules.hearing("/zx200/tracks/cmd_vel", "std_msgs/Bool"))


def test_the_clock_only_where_the_site_says_so(rules: Allowed, tmp_path: Path) -> None:
    assert rules.publishing("/clock", "rosgraph_msgs/Clock") == (
        "/clock: this site does not take the time of a simulator: its messages are left out"
    )
    there = allowed(site(tmp_path, {"clock": True}))
    assert there.publishing("/clock", "rosgraph_msgs/Clock") is None
    assert "not std_msgs/String" in str(there.publishing("/clock", "std_msgs/String"))


def test_what_sensing_reads_of_a_simulator(tmp_path: Path) -> None:
    inputs = {
        "fix": {"topic": "/zx200/gnss_compass/fix", "type": "sensor_msgs/msg/NavSatFix"},
        "ours": {"topic": "/zx200/end_effector", "type": "sensing_msgs/msg/Zx200EndEffector"},
        "trick": {"topic": "/zx200/goal_pose", "type": "geometry_msgs/msg/PoseStamped"},
    }
    (tmp_path / "s.yaml").write_text(yaml.safe_dump({"inputs": inputs}))
    rules = allowed(site(tmp_path, sensing="s.yaml"))
    assert rules.published == {
        **{name: {kind} for name, kind in PUBLISHED.items()}, "/zx200/gnss_compass/fix": {"sensor_msgs/NavSatFix"},
    }  # fmt: skip


def test_what_a_simulator_hears(rules: Allowed) -> None:
    for topic, kind in PREFAB_HEARS.items():
        assert rules.hearing(full_name(topic), kind) is None, topic
    for name in ("/tms/runs", "/rosout", "/zx200/rc/state", "/ic120/vessel/cmd", "/zx200/odom"):
        assert rules.hearing(name, "std_msgs/Bool") == (
            f"{name} is no command to this site's machines: a client may not listen there"
        )


def test_services_only_where_the_site_lists_them(rules: Allowed, tmp_path: Path) -> None:
    assert "is not among services.if.calls" in str(rules.calling("/zx200/rearm", "std_srvs/Trigger"))
    assert "is not among services.if.offers" in str(rules.offering("/gazebo/spawn", "std_srvs/Trigger"))
    lists = {"calls": {"/zx200/lamp": "std_srvs/SetBool"}, "offers": {"/gazebo/spawn": "std_srvs/Trigger"}}
    there = allowed(site(tmp_path, lists))
    assert there.calling("/zx200/lamp", "std_srvs/SetBool") is None
    assert there.calling("/gazebo/spawn", "std_srvs/Trigger") is not None
    assert there.offering("/gazebo/spawn", "std_srvs/Trigger") is None
    assert "not std_srvs/Empty: it is refused" in str(there.offering("/gazebo/spawn", "std_srvs/Empty"))


@pytest.mark.parametrize(
    ("lists", "where"),
    [
        ({"calls": {"lamp": "std_srvs/SetBool"}}, "if.calls.lamp"),
        ({"calls": {"/lamp": "SetBool"}}, "if.calls./lamp"),
        ({"offers": {"/a//b": "std_srvs/Trigger"}}, "if.offers./a//b"),
        ({"clock": "sometimes"}, "if.clock"),
    ],
)
def test_a_list_that_names_no_service(tmp_path: Path, lists: object, where: str) -> None:
    with pytest.raises(ConfigError, match=where):
        site(tmp_path, lists)


PART = st.sampled_from(
    ["zx200", "hauler", "odom", "joint_state", "base_link", "pose", "cmd_vel", "ZX200", "Odom", "clock", "tms",
     "/", "//", "~", "~/", "", " ", ".", "..", ":=", "__ns:=/x", "{name}", "*", "?", "%2f", "\0", "\n", "\u200b",
     "_action", "\u212a", "ｚｘ２００", "ö", "a" * 300]
)  # fmt: skip


@given(st.lists(PART | st.text(max_size=5), max_size=8).map("".join) | st.text(max_size=400))
def test_no_other_spelling_passes(rules: Allowed, topic: str) -> None:
    """Whatever a client writes: it is exactly a name of the list, with or without its first slash, or refused."""
    for kind in {"sensor_msgs/JointState", "nav_msgs/Odometry", "geometry_msgs/PoseStamped"}:
        passes = rules.publishing(full_name(topic), kind) is None
        assert passes == (PUBLISHED.get(topic, PUBLISHED.get(f"/{topic}")) == kind)


@given(st.lists(PART | st.text(max_size=5), max_size=8).map("".join) | st.text(max_size=400))
def test_a_registration_is_a_plain_name_or_refused(topic: str) -> None:
    payload = Registration.model_construct(topic=topic, message_name="nav_msgs/Odometry").model_dump_json()
    try:
        taken = parse(Registration, "__publish", payload.encode())
    except (CommandError, UnicodeEncodeError):
        return
    assert taken.topic == topic
    assert topic.isascii() and topic.replace("/", "").replace("_", "").isalnum()
    assert len(topic) <= 246 and "//" not in topic and not topic.endswith("/")


@given(st.sampled_from(sorted(PUBLISHED)), st.data())
def test_one_letter_more_or_less_is_another_name(rules: Allowed, name: str, data: st.DataObject) -> None:
    place = data.draw(st.integers(1, len(name)))
    letter = data.draw(st.characters() | st.sampled_from("/~_ \0"))
    for other in (name[:place] + letter + name[place:], name[: place - 1] + name[place:], name.upper(), f"{name}/"):
        if full_name(other) not in PUBLISHED:
            assert rules.publishing(full_name(other), PUBLISHED[name]) is not None
