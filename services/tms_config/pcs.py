"""The PCs of a site: without `pcs:` in the site file everything runs on one PC."""

from tms_config.config import Site
from tms_config.reasons import WhichPc
from tms_reason.errors import ConfigError


def required(site: Site) -> None:
    """Refuse to start or to use ROS while it is not known which PC this is.

    Raises:
        ConfigError: says how to choose the PC.
    """
    if site.file.pcs and site.pc is None:
        raise ConfigError(WhichPc(site.name, tuple(site.file.pcs)))
