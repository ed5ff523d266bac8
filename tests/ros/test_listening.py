"""Nothing listens beyond loopback unless the site file says so."""

import os
from pathlib import Path

import psutil
import pytest
import yaml

import programs
from conftest import ports_of, site_data, wait_until
from tms_config.config import load_site
from tms_config.processes import find

LOOPBACK = {"127.0.0.1", "239.255.0.1"}  # the group of DDS discovery is joined on the loopback interface only


@pytest.mark.parametrize("name", ["tms:ts", "tms:ur", "zx200:rc"])
def test_a_process_of_a_single_pc_listens_on_loopback_only(name: str, own_domain: int, tmp_path: Path) -> None:
    file = tmp_path / "site.yaml"
    file.write_text(yaml.safe_dump(site_data(own_domain, ports_of(own_domain))))
    environment = {**os.environ, "TMS_SITE": str(file), "TMS_STATE": str(tmp_path), "ROS_DOMAIN_ID": str(own_domain)}
    row = find(load_site(str(file)), name)
    running = programs.process(name, environment, tmp_path / "log")
    try:
        wait_until(lambda: "event=started" in (tmp_path / "log").read_text(), 20, "it has started")
        listening = {c.laddr.ip for c in psutil.Process(running.pid).net_connections("inet") if not c.raddr}
        assert row.address in listening and listening <= LOOPBACK
    finally:
        running.terminate()
        running.wait(10)
