"""A process that ends again and again, under a real supervisord: it can be stopped, started and restarted."""

import configparser
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
import yaml

from conftest import site_data, wait_until
from tms_config.config import Site, load_site
from tms_config.processes import here
from tms_host.supervisor import Supervisor, render

pytestmark = pytest.mark.system
NAME = "tms:db"
PROGRAM = "[ -e {mended} ] && exec sleep 100; exit 1"
TRIES = "50"  # so many that it is between two of them all through the test


@pytest.fixture
def site(tmp_path: Path) -> Iterator[Site]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("TMS_STATE", str(tmp_path / "state"))
        patch.delenv("ROS_DOMAIN_ID", raising=False)
        file = tmp_path / "site.yaml"
        file.write_text(yaml.safe_dump(site_data(51, 21000, services={"db": {}}, machines={})))
        (tmp_path / "state" / "log").mkdir(parents=True)
        yield load_site(str(file))


@pytest.fixture
def supervisor(site: Site, tmp_path: Path) -> Iterator[Supervisor]:
    """With a program in the place of `tms:db` that works as soon as there is a file `mended`."""
    parser = configparser.RawConfigParser()
    parser.read_string(render(site, tuple(row for row in here(site) if row.full == NAME)))
    (program,) = (name for name in parser.sections() if name.startswith("program:"))
    (tmp_path / "program.sh").write_text(PROGRAM.format(mended=tmp_path / "mended"))
    parser[program]["command"] = f"sh {tmp_path / 'program.sh'}"
    parser[program]["startretries"] = TRIES
    conf = tmp_path / "supervisord.conf"
    with conf.open("w") as file:
        parser.write(file)
    words = [sys.executable, "-m", "supervisor.supervisord", "--nodaemon", "-c", str(conf)]
    with subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as daemon:
        calls = Supervisor(site)
        try:
            wait_until(calls.alive, 20, "supervisord answers")
            yield calls
        finally:
            calls.close()
            daemon.terminate()


def state(supervisor: Supervisor) -> str:
    return next(row.state for row in supervisor.processes() if row.name == NAME)


@pytest.fixture
def waiting(supervisor: Supervisor) -> Supervisor:
    """Now it waits for the next attempt, which comes a second later after each that failed."""
    for attempt in ("second", "third"):
        wait_until(lambda: state(supervisor) == "BACKOFF", 20, f"it waits for the {attempt} attempt")
        wait_until(lambda: state(supervisor) != "BACKOFF", 20, f"the {attempt} attempt", every=0.001)
    wait_until(lambda: state(supervisor) == "BACKOFF", 20, "it waits again, for three seconds")
    return supervisor


def test_stop_ends_the_attempts(waiting: Supervisor) -> None:
    waiting.control("stop", NAME)
    assert state(waiting) == "STOPPED"
    waiting.control("stop", NAME)  # it is already, which is no error


@pytest.mark.parametrize("command", ["start", "restart"])
def test_it_is_started_at_once(waiting: Supervisor, tmp_path: Path, command: str) -> None:
    (tmp_path / "mended").touch()
    waiting.control(command, NAME)
    wait_until(lambda: state(waiting) == "RUNNING", 20, "it runs")
