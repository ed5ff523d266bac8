"""A process that hangs in DDS as it leaves the graph."""

import os
import subprocess
import sys
from pathlib import Path

from conftest import ports_of, wait_until
from tms_config.config import load_site
from tms_runtime import environment

SITE = """
name: leaving
domain: {domain}
ports: {{metrics: {port}}}
services: {{}}
machines: {{zx200: {{model: zx200}}}}
"""
HANGS = """
import ctypes, sys
from tms_runtime import run
from tms_ros.node import Ros
Ros.leave = lambda self: ctypes.PyDLL(None).sleep(60)  # native code that keeps the interpreter
sys.exit(run.main("sim:zx200"))
"""


def test_a_process_that_hangs_as_it_leaves_has_logged_all_and_ends(own_domain: int, tmp_path: Path) -> None:
    (tmp_path / "site.yaml").write_text(SITE.format(domain=own_domain, port=ports_of(own_domain)))
    site = load_site(str(tmp_path / "site.yaml"))
    env = {**os.environ, **environment.environment(site), "TMS_STATE": str(tmp_path)}
    log = tmp_path / "log.txt"
    with log.open("wb") as out:
        process = subprocess.Popen([sys.executable, "-c", HANGS], env=env, stdout=out, stderr=out)
        try:
            wait_until(lambda: "event=started" in log.read_text() or process.poll() is not None, 60, "it has started")
            process.terminate()
            assert process.wait(40) == 0, log.read_text()
        finally:
            process.kill()
            process.wait()
    assert "event=stopped" in log.read_text()
