"""Environment variables of every process of a mesh; set before rclpy starts."""

import os
from pathlib import Path

from tms_config.config import PROJECT, Site
from tms_runtime import addresses, state_folder

# UDP on one interface only, no shared memory: the LOCALHOST range of Fast DDS silently loses
# everything above 32 participants, and shared memory leaks with every killed process.
PROFILE = PROJECT / "deploy" / "dds" / "loopback.xml"
ON_LOOPBACK = {
    "ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET",  # who starts tells all others by multicast
    "FASTRTPS_DEFAULT_PROFILES_FILE": str(PROFILE),
    "RMW_FASTRTPS_USE_QOS_FROM_XML": "1",  # heartbeats: see the profile
}
TELLS_FEW = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "SYSTEM_DEFAULT"}  # those that the profile names
LOOPBACK = "<address>127.0.0.1</address>"
MULTICAST = "<avoid_builtin_multicast>false<", "<avoid_builtin_multicast>true<"  # one PC; several
FIRST_FOUR = "<initialPeersList><locator><udpv4><address>127.0.0.1</address></udpv4></locator></initialPeersList>"


def environment(site: Site) -> dict[str, str]:
    """The variables that a process of this site needs in addition to PATH and HOME.

    Raises:
        ConfigError: it is not known which PC of the site this is, or its address is not known.
    """
    server = addresses.discovery_server(site)
    # A super client discovers all endpoints, not only those that it uses: preflight asks for others' servers.
    discovery = {"ROS_DISCOVERY_SERVER": server, "ROS_SUPER_CLIENT": "TRUE"} if server else {}
    return {
        **discovery,
        **({"TMS_PC": site.pc} if site.pc else {}),
        **ON_LOOPBACK,
        "ROS_DOMAIN_ID": str(site.domain),
        "ROS_LOG_DIR": str(site.state / "ros"),
        "FASTRTPS_DEFAULT_PROFILES_FILE": str(_profile(site)),
        "TMS_SITE": str(site.path),
        "TMS_STATE": str(site.state),
        "OPENBLAS_NUM_THREADS": "1",  # rclpy loads numpy, whose threads are of no use here
        "HOME": os.environ.get("HOME") or str(Path("/tmp")),  # rclpy does not start without one
        "PYTHONPATH": str(PROJECT / "services"),
        "PYTHONUNBUFFERED": "1",
    }


def _profile(site: Site) -> Path:
    """The loopback profile; on a site of several PCs, a copy with this PC's address and other multicast."""
    if not site.file.pcs:
        return PROFILE
    address = addresses.resolve(site, site.file.pcs[site.require_pc()].address)
    path = site.state / "dds.xml"
    text = PROFILE.read_text(encoding="utf-8").replace(*MULTICAST).replace(FIRST_FOUR, "")
    text = text.replace(LOOPBACK, f"<address>{address}</address>{LOOPBACK}")
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        state_folder.make(site.state)
        with state_folder.private():
            path.write_text(text, encoding="utf-8")
    return path


def enter(site: Site, *, tells_few: bool = False) -> None:
    """Give this process the environment of the site; with `tells_few`, only a few others hear of it at first."""
    os.environ.update(environment(site) | (TELLS_FEW if tells_few and not site.file.pcs else {}))
    state_folder.make(site.state)
    (site.state / "ros").mkdir(mode=0o700, exist_ok=True)
