"""The unit and the program `tms` beside it: people's commands get the environment of the mesh that systemd started."""

import configparser
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import yaml

from conftest import PROJECT
from tms_runtime.priority import URGENT

FOLDER = PROJECT / "deploy" / "systemd"
UNIT = configparser.RawConfigParser(strict=False)
UNIT.optionxform = str  # type: ignore[assignment,method-assign]
UNIT.read(FOLDER / "tms@.service")
WRAPPER = (FOLDER / "tms").read_text()
STOPPING = ("cps", "scheduler", "machine")  # roles whose processes send a stop, or stop a machine
TELL = """#!{python}
import json, os, sys
json.dump({{"argv": sys.argv[1:], "environment": dict(os.environ)}}, sys.stdout)
"""


def assigned(text: str) -> dict[str, str]:
    return dict(re.findall(r"(\S+?)=(\S+)", text))


def script(path: Path, text: str) -> None:
    path.write_text(text)
    path.chmod(0o755)


def test_unit_and_program_name_the_same_environment() -> None:
    unit = assigned(UNIT["Service"]["Environment"])
    del unit["TMS_PC"]  # `tms up` leaves it in the state folder
    (line,) = re.findall(r"^exec sudo -u (\w+) env (.*) \"\$@\"$", WRAPPER, re.MULTILINE)
    assert line == (UNIT["Service"]["User"], line[1])
    assert assigned(line[1]) == unit
    assert UNIT["Service"]["EnvironmentFile"] in WRAPPER


def test_the_socket_is_where_people_see_it() -> None:
    """Without a folder of its own the unit would have it in its private /tmp."""
    service = UNIT["Service"]
    assert assigned(service["Environment"])["XDG_RUNTIME_DIR"] == f"/run/{service['RuntimeDirectory']}"
    assert service["RuntimeDirectoryMode"] == "0700"


def test_unit_and_containers_allow_the_priority_of_a_stop() -> None:
    roles = [yaml.safe_load((PROJECT / f"deploy/compose/{role}.yml").read_text()) for role in STOPPING]
    allowed = {one["services"]["tms"]["ulimits"]["rtprio"] for one in roles}
    assert {*allowed, int(UNIT["Service"]["LimitRTPRIO"])} == {URGENT}


def test_the_program_passes_words_and_the_sites_variables(tmp_path: Path) -> None:
    site, real, fakes = tmp_path / "site", tmp_path / "real", tmp_path / "bin"
    fakes.mkdir()
    site.write_text('# our site\nTMS_SITE=genba\n\n;x=y\nTMS_ALERTS_TO="127.0.0.1:9093"\nTMS_NOTE=two words')
    script(real, TELL.format(python=sys.executable))
    script(fakes / "sudo", '#!/bin/sh\n[ "$1 $2" = "-u tms" ] || exit 9\nshift 2\nexec "$@"\n')
    script(tmp_path / "tms", WRAPPER.replace("/etc/tms/site", str(site)).replace("/opt/tms/.venv/bin/tms", str(real)))
    argv = ["task", "add", "my file.xml", "--description", "a 'b' $c"]
    env = {"PATH": f"{fakes}:{os.environ['PATH']}"}
    done = subprocess.run([str(tmp_path / "tms"), *argv], env=env, capture_output=True, text=True, check=True)
    reported = json.loads(done.stdout)
    assert reported["argv"] == argv
    there = reported["environment"]
    wanted = {
        "TMS_SITE": "genba", "TMS_ALERTS_TO": "127.0.0.1:9093", "TMS_NOTE": "two words",
        "TMS_STATE": "/var/lib/tms/state", "TMS_PROMETHEUS": "/var/lib/tms/prometheus", "XDG_RUNTIME_DIR": "/run/tms",
    }  # fmt: skip
    assert {key: there[key] for key in wanted} == wanted
