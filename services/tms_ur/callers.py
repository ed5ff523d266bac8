"""What counts as one caller, so that a client cannot pose as many: an IPv4 address, or the /64 of an IPv6 address."""

import ipaddress


def caller(address: str) -> str:
    """The key under which connections and wrong passwords from `address` are counted.

    A host with one IPv6 address can, as a rule, use all addresses with the same first 64 bits.
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
