"""Makes the URI of the site's MongoDB from the site file and the password file."""

import os
from pathlib import Path
from urllib.parse import quote, urlencode

from tms_config.config import Site
from tms_config.reasons import BadFile, BadVariable, CannotBeRead
from tms_config.site_file import Store
from tms_config.yaml_file import located, read_text
from tms_db.reasons import EmptyFile
from tms_reason.errors import ConfigError


def uri(site: Site) -> str:
    """URI of the store, with its password: never log it.

    Raises:
        ConfigError: a file with a secret cannot be read.
    """
    if given := _secret("TMS_MONGODB_URI"):
        return given
    if given := site.file.store.uri:
        return _with_login(site.file.store, given, site.path)
    return f"mongodb://127.0.0.1:{site.file.ports.store}/?directConnection=true"


def _secret(name: str) -> str | None:
    """Value of a variable, or of the file that NAME_FILE names, as containers and systemd hand out secrets."""
    path = os.environ.get(f"{name}_FILE")
    if name in os.environ or not path:
        return os.environ.get(name)
    try:
        return Path(path).read_text(encoding="utf-8").strip()
    except OSError as error:
        problem = BadFile(path, CannotBeRead(str(error.strerror)))
        raise ConfigError(BadVariable(f"{name}_FILE", problem)) from error


def _with_login(store: Store, uri: str, site: Path) -> str:
    """The URI with user, password and TLS files of the site; files are looked for beside the site file.

    Raises:
        ConfigError: the password's file cannot be read or is empty; no message holds the password.
    """
    scheme, _, rest = uri.partition("://")
    if store.user is not None and store.password_file is not None:
        password = _password(site, site.parent / store.password_file)
        rest = f"{quote(store.user, safe='')}:{quote(password, safe='')}@{rest}"
    options: dict[str, str] = {}
    if store.tls_ca is not None:
        options = {"tls": "true", "tlsCAFile": str(site.parent / store.tls_ca)}
    if store.tls_certificate is not None:
        options |= {"tls": "true", "tlsCertificateKeyFile": str(site.parent / store.tls_certificate)}
    if options:
        rest += ("/" if "/" not in rest else "") + ("&" if "?" in rest else "?") + urlencode(options)
    return f"{scheme}://{rest}"


def _password(site: Path, path: Path) -> str:
    key = "store", "password_file"
    try:
        found = read_text(path).rstrip("\r\n")
    except ConfigError as error:
        raise ConfigError(located(site, error.reason, *key)) from error
    if not found:
        raise ConfigError(located(site, BadFile(str(path), EmptyFile()), *key))
    return found
