"""The topics and services that a client may publish, receive, call and serve: only those listed here or in the site."""

from collections.abc import Mapping
from dataclasses import dataclass

from tms_config.config import Site
from tms_if.interfaces import short_name
from tms_machine.sensing import load_sensing

Named = Mapping[str, frozenset[str]]  # full name -> types that it may have, as pkg/Type

POSE = {"PoseStamped": "geometry_msgs/PoseStamped", "Odometry": "nav_msgs/Odometry"}
CLOCK = "/clock"
# Topics that simulated machines publish beyond their borders; allowed where a sensing input reads them.
FURTHER = (
    "gnss_compass/fix", "gnss_compass/heading", "g2_imu", "swing/g2_imu", "boom/g2_imu", "arm/g2_imu", "bucket/g2_imu",
    "bucket/g2_imu_sim", "base_link/pose", "global_pose", "odom", "odom_pose", "soil_volume",
)  # fmt: skip
# Topics that they receive beyond the commands of their borders.
RECEIVED = {"track_cmd": "com3_msgs/JointCmd", "unity/drive_params": "std_msgs/Float64MultiArray"}
RECEIVED_BY_ALL = {
    "/tf": "tf2_msgs/TFMessage", "/move_group/fake_controller_joint_states": "sensor_msgs/JointState",
}  # fmt: skip


@dataclass(frozen=True)
class Allowed:
    """The allowed names of a site."""

    published: Named
    received: Named
    called: Named
    offered: Named
    stops: frozenset[str] = frozenset()  # topics of the machines' emergency stops

    def publishing(self, name: str, kind: str) -> str | None:
        """Why a client may not publish this full name; None if it may."""
        if name == CLOCK and name not in self.published:
            return f"{name}: this site does not take the time of a simulator: its messages are left out"
        return _refusal(
            self.published, name, kind, "is no sensor topic of this site's machines: its messages are left out"
        )

    def hearing(self, name: str, kind: str) -> str | None:
        """Why a client may not receive this topic; None if it may."""
        return _refusal(
            self.received, name, kind, "is no command to this site's machines: a client may not listen there"
        )

    def calling(self, name: str, kind: str) -> str | None:
        """Why a client may not call this service; None if it may."""
        return _refusal(self.called, name, kind, "is not among services.if.calls of the site file: it is not called")

    def offering(self, name: str, kind: str) -> str | None:
        """Why a client may not serve this service; None if it may."""
        return _refusal(self.offered, name, kind, "is not among services.if.offers of the site file: it is not offered")


def allowed(site: Site) -> Allowed:
    """The allowed names of a site, from its machines' borders, its sensing inputs and its settings of the bridge.

    Raises:
        ConfigError: the sensing inputs cannot be read.
    """
    settings = site.bridge
    return Allowed(
        published={
            **_inputs(site),
            **_sensors(site),
            **({CLOCK: _one("rosgraph_msgs/Clock")} if settings.clock else {}),
        },
        received={name: _one(kind) for name, kind in {**_commands(site), **RECEIVED_BY_ALL}.items()},
        called={name: _one(kind) for name, kind in settings.calls.items()},
        offered={name: _one(kind) for name, kind in settings.offers.items()},
        stops=frozenset(f"/{name}/{stop}" for name in site.file.machines if (stop := site.border(name).emg_stop)),
    )


def _refusal(named: Named, name: str, kind: str, otherwise: str) -> str | None:
    if name not in named:
        return f"{name} {otherwise}"
    if kind not in named[name]:
        return f"{name} is {' or '.join(sorted(named[name]))} on this site, not {kind}: it is refused"
    return None


def _one(kind: str) -> frozenset[str]:
    return frozenset({kind})


def _sensors(site: Site) -> dict[str, frozenset[str]]:
    """Topics that report the machines' motion."""
    found: dict[str, frozenset[str]] = {}
    for machine in site.file.machines:
        border = site.border(machine)
        topics = {border.joint_states: "sensor_msgs/JointState", border.odom: "nav_msgs/Odometry"}
        topics[border.imu] = "sensor_msgs/Imu"
        if border.pose:
            topics[border.pose] = POSE[border.sources["pose"].message]
        found |= {f"/{machine}/{topic}": _one(kind) for topic, kind in topics.items() if topic}
    return found


def _inputs(site: Site) -> dict[str, frozenset[str]]:
    """Further topics of simulated machines that sensing reads."""
    there = {f"/{machine}/{topic}" for machine in site.file.machines for topic in FURTHER}
    found: dict[str, frozenset[str]] = {}
    for given in load_sensing(site).inputs.values():
        name = f"/{given.topic.removeprefix('/')}"
        if name in there:
            found[name] = found.get(name, frozenset()) | {short_name(given.type)}
    return found


def _commands(site: Site) -> dict[str, str]:
    """Topics that command the machines."""
    found: dict[str, str] = {}
    for machine in site.file.machines:
        border = site.border(machine)
        topics: dict[str | None, str] = {border.cmd_vel: "geometry_msgs/Twist", border.emg_stop: "std_msgs/Bool"}
        topics[border.joint_cmd] = "com3_msgs/JointCmd"
        topics |= dict.fromkeys(border.joint_angles.values(), "std_msgs/Float64")
        topics.update(RECEIVED)
        found |= {f"/{machine}/{topic}": kind for topic, kind in topics.items() if topic}
    return found
