"""The console's address, certificate and users as the site file says; loads no web server, so that `tms` may use it.

A path in the site file is relative to that file, whatever folder the mesh is started in.
"""

import ssl
from pathlib import Path

from tms_config.config import Site
from tms_config.site_file import Files, SiteFile
from tms_reason.errors import ConfigError
from tms_reason.reason import Reason
from tms_ur.reasons import NoCertificate, UnreadableCertificate

ALL = {"0.0.0.0": "127.0.0.1", "::": "::1"}  # bound to all addresses: a browser on this PC uses this one


def url(file: SiteFile) -> str:
    """The console's URL for a browser on this PC."""
    host = ALL.get(file.bind, file.bind)
    shown = f"[{host}]" if ":" in host else host
    return f"http{'s' if file.console.tls else ''}://{shown}:{file.ports.console}"


def certificate(site: Site) -> Files | None:
    """Certificate and key for the web server, checked; None where the site has none.

    Raises:
        ConfigError: one of them cannot be read, or they do not belong together.
    """
    given = site.file.console.tls
    if given is None:
        return None
    found = Files(certificate=site.path.parent / given.certificate, key=site.path.parent / given.key)
    for name, path in (("certificate", found.certificate), ("key", found.key)):
        try:
            path.open("rb").close()
        except OSError as error:
            reason: Reason = UnreadableCertificate(str(site.path), name, str(path), str(error.strerror))
            raise ConfigError(reason) from error
    try:
        # Without this password OpenSSL would ask on the terminal for the password of an encrypted key.
        ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER).load_cert_chain(found.certificate, found.key, password=lambda: "none")
    except ssl.SSLError as error:
        problem = str(error.reason or error)
        reason = NoCertificate(str(site.path), str(found.certificate), str(found.key), problem)
        raise ConfigError(reason) from error
    return found


def users(site: Site) -> Path | None:
    """The users file for `tms:ur`, checked; None where the site has none.

    Raises:
        ConfigError: it cannot be read, is wrong, or is readable by other users.
    """
    from tms_ur.access import read_users  # hashing takes a moment to load, and most verbs of `tms` do not need it

    given = site.file.console.users
    if given is None:
        return None
    file = site.path.parent / given
    read_users(file)
    return file
