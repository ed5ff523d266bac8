"""Who counts as one caller where somebody might want to be many: an IPv4 address, or the /64 of an IPv6 address."""

import ipaddress


def caller(address: str) -> str:
    """The key under which connections and wrong passwords from `address` are counted.

    Whoever has one IPv6 address has, as a rule, all that begin with the same 64 bits.
    """
    try:
        found = ipaddress.ip_address(address)
    except ValueError:  # "-": a connection without an address
        return address
    if found.version == 4:
        return str(found)
    if found.ipv4_mapped is not None:
        return str(found.ipv4_mapped)
    return str(ipaddress.ip_network((int(found), 64), strict=False))
