"""The PCs of a site: which of them runs what, under which address, and how DDS goes between them.

Without `pcs:` in the site file everything runs on one PC and DDS stays on its loopback interface. Otherwise every
process of a PC listens on that PC's address only, and DDS uses that address and the loopback interface: a machine's
own processes must still reach each other when the cable is out.
"""

import ipaddress
import os
import socket
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from pydantic import Field

from tms_config.models import Settings
from tms_config.reasons import ManyPcsFor, NoAddress, NoCps, NoPcFor, NoRole, NoSuchPc, NotUnderMachines, WhichPc
from tms_config.yaml_file import located
from tms_reason.errors import ConfigError

if TYPE_CHECKING:
    from tms_config.config import Site
    from tms_config.processes import Process
    from tms_config.site_file import SiteFile

Role = Literal["cps", "machine", "sensing", "sim"]
ROLES: tuple[Role, ...] = ("cps", "machine", "sensing", "sim")
LOOPBACK = "127.0.0.1"
CHOICE = "pc"  # file in the state folder: which PC this is, as chosen by `tms up --role`


class Pc(Settings):
    """One PC of the site; its name is its key."""

    address: str = Field(min_length=1)  # IP address or name, as the other PCs reach it
    roles: tuple[Role, ...] = ()  # default: the one that the PC is named after
    machines: tuple[str, ...] = ()  # whose processes run here; default: those of no other PC with that role


class Network(Settings):
    """How processes of different PCs find each other."""

    # server: across segments that pass no multicast. A server that is killed may leave new processes unfound for half a
    # minute, so it is no default, not even for the many processes that it makes cheaper.
    discovery: Literal["multicast", "server"] = "multicast"
    port: int = Field(ge=1024, le=65535, default=11811)  # of the discovery server, on the PC with the role cps


def roles(name: str, pc: Pc) -> tuple[Role, ...]:
    """What a PC does."""
    return pc.roles or tuple(role for role in ROLES if role == name)


def check(path: Path, file: "SiteFile") -> None:
    """Refuse PCs without a role, roles without a PC, and machines that two PCs or none would run.

    Raises:
        ConfigError: names the file and the key.
    """
    for name, pc in file.pcs.items():
        if not roles(name, pc):
            raise ConfigError(located(path, NoRole(ROLES), "pcs", name))
        for machine in pc.machines:
            if machine not in file.machines:
                raise ConfigError(
                    located(path, NotUnderMachines(machine, tuple(file.machines)), "pcs", name, "machines")
                )


def place(site: "Site", row: "Process") -> str:
    """Name of the PC that runs a process; empty when the site is one PC.

    Raises:
        ConfigError: no PC or several would run it.
    """
    pcs = site.file.pcs
    able = [name for name, pc in pcs.items() if row.role in roles(name, pc)]
    named = [name for name in able if row.machine in pcs[name].machines]
    fit = named or [name for name in able if not pcs[name].machines]
    if not pcs:
        return ""
    if len(fit) != 1:
        problem = ManyPcsFor(tuple(fit), row.full, row.role) if fit else NoPcFor(row.full, row.role)
        raise ConfigError(located(site.path, problem, "pcs"))
    return fit[0]


def chosen(path: Path, file: "SiteFile", state: Path) -> str | None:
    """Which PC this is: TMS_PC, else what the last `tms up --role` chose here, else the only one.

    Raises:
        ConfigError: the site has no such PC.
    """
    kept = state / CHOICE
    name = os.environ.get("TMS_PC") or (kept.read_text(encoding="utf-8").strip() if kept.exists() else "")
    name = name or (next(iter(file.pcs)) if len(file.pcs) == 1 else "")
    if not file.pcs or not name:
        return None
    if name not in file.pcs:
        raise ConfigError(located(path, NoSuchPc(name, tuple(file.pcs)), "pcs"))
    return name


def required(site: "Site") -> None:
    """Refuse to start or to talk while it is not known which PC this is.

    Raises:
        ConfigError: says how to tell.
    """
    if site.file.pcs and site.pc is None:
        raise ConfigError(WhichPc(site.name, tuple(site.file.pcs)))


def discovery_server(site: "Site") -> str | None:
    """host:port of the discovery server, where the site uses one; on loopback where the site is one PC.

    Raises:
        ConfigError: no PC would run it, or its address is not known.
    """
    if site.file.network.discovery != "server":
        return None
    if not site.file.pcs:
        return f"{LOOPBACK}:{site.file.network.port}"
    cps = next((pc.address for name, pc in site.file.pcs.items() if "cps" in roles(name, pc)), None)
    if cps is None:
        raise ConfigError(located(site.path, NoCps(), "network", "discovery"))
    return f"{resolve(site, cps)}:{site.file.network.port}"


def resolve(site: "Site", address: str) -> str:
    """IPv4 address of a PC; DDS takes no names.

    Raises:
        ConfigError: the name is not known.
    """
    try:
        return str(ipaddress.IPv4Address(address))
    except ValueError:
        pass
    try:
        return socket.gethostbyname(address)
    except OSError as error:
        raise ConfigError(located(site.path, NoAddress(address, str(error.strerror)), "pcs")) from error
