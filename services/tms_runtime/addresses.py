"""The addresses that DDS uses.

Without `pcs:` in the site file DDS stays on this PC's loopback interface. Otherwise every process of a PC listens on
that PC's address only, and DDS uses that address and the loopback interface: a machine's own processes must still reach
each other when the cable is out.
"""

import ipaddress
import socket

from tms_config.config import Site
from tms_config.reasons import NoAddress
from tms_config.site_file import roles
from tms_config.yaml_file import located
from tms_reason.errors import ConfigError

LOOPBACK = "127.0.0.1"


def discovery_server(site: Site) -> str | None:
    """host:port of the discovery server, None where the site uses none; on loopback for a site of one PC.

    Raises:
        ConfigError: its address is not known.
    """
    if site.file.network.discovery != "server":
        return None
    cps = (pc.address for name, pc in site.file.pcs.items() if "cps" in roles(name, pc))
    host = resolve(site, next(cps)) if site.file.pcs else LOOPBACK
    return f"{host}:{site.file.network.port}"


def resolve(site: Site, address: str) -> str:
    """IPv4 address of a PC, since DDS accepts no names.

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
