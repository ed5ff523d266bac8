"""Names that belong to this system: a client of the bridge may listen to them, but not speak under them."""

from tms_core.config import Site

OURS = ("/tms/", "/emergency_signal", "/parameter_events", "/rosout")
PARTS = ("/_action/", "/rc/", "/permit/", "/rearm")


def reserved(site: Site) -> frozenset[str]:
    """Topics that command the site's machines: only the gateways may publish on them."""
    found = set()
    for machine in site.file.machines:
        border = site.border(machine)
        topics = (border.cmd_vel, border.emg_stop, border.joint_cmd, *border.joint_angles.values())
        found |= {f"/{machine}/{topic}" for topic in topics if topic}
    return frozenset(found)


def refusal(name: str, commands: frozenset[str]) -> str | None:
    """Why a client may not publish, offer or call this full name; None if it may."""
    if name in commands:
        return f"{name} commands a machine: a simulator may only listen there"
    if name.startswith(OURS) or any(part in f"{name}/" for part in PARTS):
        return f"{name} belongs to the task management: a client may only listen"
    return None
