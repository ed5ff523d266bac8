"""`tms:discovery`: Fast DDS's discovery server, for sites whose network passes no multicast."""

import os
import sys
from pathlib import Path

from tms_config.config import Site
from tms_host.reasons import NoProgram
from tms_reason.errors import ConfigError
from tms_runtime.addresses import discovery_server


def exec_program(site: Site) -> None:
    """Replace this process by the server (same pid, so supervisord sees the real one).

    Raises:
        ConfigError: the site uses none, or the program is missing.
    """
    address = discovery_server(site)
    program = Path(sys.executable).parent / "fast-discovery-server"
    if address is None or not program.exists():
        raise ConfigError(NoProgram(str(program)))
    host, _, port = address.partition(":")
    os.environ.pop("ROS_DISCOVERY_SERVER", None)
    os.execv(program, [str(program), "-i", "0", "-l", host, "-p", port])
