"""supervisord's configuration is rendered from the process table; paths cannot break it."""

import configparser
from pathlib import Path
from typing import Any

import pytest
import yaml

from conftest import site_data
from tms_config.config import Site, load_site
from tms_config.processes import table
from tms_host import supervisor as module
from tms_host.supervisor import AT_ONCE, Supervisor, SupervisorDown, render, runtime_folder, socket_path
from tms_reason.errors import ConfigError, TmsError


@pytest.fixture
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Site:
    file = tmp_path / "site.yaml"
    file.write_text(yaml.safe_dump(site_data(51, 21000)))
    monkeypatch.setenv("TMS_STATE", str(tmp_path / "state %d"))
    monkeypatch.delenv("ROS_DOMAIN_ID", raising=False)
    return load_site(str(file))


def test_every_process_is_a_program_of_its_group(site: Site) -> None:
    parser = configparser.RawConfigParser()
    parser.read_string(render(site))
    programs = {name.removeprefix("program:") for name in parser.sections() if name.startswith("program:")}
    assert programs == {f"{row.group}.{row.name}" for row in table(site)}
    members = [parser[name]["programs"] for name in parser.sections() if name.startswith("group:")]
    assert {word for line in members for word in line.split(",")} == programs


def test_subtasks_wait_until_a_task_names_them(site: Site) -> None:
    parser = configparser.RawConfigParser()
    parser.read_string(render(site))
    assert parser["program:zx200.subtask_zx200_change_pose"]["autostart"] == "false"
    assert parser["program:zx200.rc"]["autostart"] == "true"


def test_the_store_starts_first(site: Site) -> None:
    """Its start needs none of the libraries that are loaded for the others, and tms:db waits for it."""
    parser = configparser.RawConfigParser()
    parser.read_string(render(site))
    first = {name for name in parser.sections() if parser[name].get("priority") == str(AT_ONCE)}
    assert first == {"group:tms", "program:tms.store"}


def test_percent_signs_in_paths_are_escaped(site: Site) -> None:
    assert "state %%d/log/tms.ts.log" in render(site)


def test_quotes_in_paths_are_refused(site: Site, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TMS_STATE", '/tmp/a"b')
    with pytest.raises(ConfigError, match="quote"):
        render(load_site(str(site.path)))


def test_the_socket_path_fits_into_a_unix_address(site: Site, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TMS_STATE", "/tmp/" + "deep/" * 60)
    assert len(str(socket_path(load_site(str(site.path))))) < 107


def test_a_foreign_runtime_folder_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    runtime_folder().chmod(0o755)
    with pytest.raises(ConfigError, match="not private"):
        runtime_folder()


def test_no_supervisord_is_told_in_one_line(site: Site) -> None:
    supervisor = Supervisor(site)
    assert not supervisor.alive()
    with pytest.raises(SupervisorDown, match="make up"):
        supervisor.processes()


class Scripted(Supervisor):
    """A supervisord that shows one process in these states, one a look; the last one stays."""

    def __init__(self, site: Site, *states: str) -> None:
        super().__init__(site)
        self.states, self.shown = list(states), ""
        self.did: list[str] = []

    def _call(self, method: str, *words: object) -> Any:
        if method != "getAllProcessInfo":
            if self.shown != "STOPPING":  # then it says that all is well, and does nothing
                self.did.append(method)
            return True
        self.shown = self.states.pop(0) if len(self.states) > 1 else self.states[0]
        row = {"group": "zx200", "name": "rc", "statename": self.shown, "pid": 7, "now": 9, "start": 1}
        return [{**row, "description": ""}]


@pytest.mark.parametrize(
    ("command", "states", "did"),
    [
        ("start", ["STOPPED"], ["startProcess"]),
        ("start", ["RUNNING"], []),
        ("start", ["STOPPING", "STOPPING", "STOPPED"], ["startProcess"]),
        ("restart", ["STOPPING", "STOPPED"], ["startProcess"]),
        ("stop", ["STOPPING", "STOPPED"], []),
        ("start", ["STOPPING", "RUNNING"], []),  # somebody else was faster
        ("restart", ["RUNNING"], ["stopProcess", "startProcess"]),
        ("start", ["BACKOFF"], ["stopProcess", "startProcess"]),
    ],
)
def test_a_process_that_ends_is_waited_for(
    site: Site, monkeypatch: pytest.MonkeyPatch, command: str, states: list[str], did: list[str]
) -> None:
    monkeypatch.setattr(module, "END_CHECK_PERIOD", 0.0)
    supervisor = Scripted(site, *states)
    supervisor.control(command, "zx200:rc")
    assert supervisor.did == did


def test_a_process_that_does_not_end_is_told(site: Site, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "END_CHECK_PERIOD", 0.0)
    monkeypatch.setattr(module, "END_LIMIT", 0.02)
    supervisor = Scripted(site, "STOPPING")
    with pytest.raises(TmsError, match="zx200:rc was told to end"):
        supervisor.control("start", "zx200:rc")
    assert supervisor.did == []


def test_the_end_of_a_log_begins_with_a_whole_line(site: Site) -> None:
    supervisor = Scripted(site, "RUNNING")
    with pytest.raises(TmsError, match="No such file"):
        supervisor.log("zx200:rc", 100)
    (site.state / "log").mkdir(parents=True)
    (site.state / "log" / "zx200.rc.log").write_text("掘削\n" * 100, encoding="utf-8")
    for size in range(100, 111):  # wherever in a character the cut falls
        text = supervisor.log("zx200:rc", size)
        assert set(text.splitlines()) == {"掘削"}
        assert size - 7 <= len(text.encode()) <= size
    assert supervisor.log("zx200:rc", 10_000) == "掘削\n" * 100
    (site.state / "log" / "zx200.rc.log").write_bytes(b"\xff\n")
    assert supervisor.log("zx200:rc", 100) == "\ufffd\n"


@pytest.mark.parametrize("name", ["zx200:ts", "../secret", ":../../secret"])
def test_only_logs_of_processes_are_read(site: Site, name: str) -> None:
    with pytest.raises(TmsError, match="no process") as refused:
        Scripted(site, "RUNNING").log(name, 100)
    assert refused.value.code == "NO_PROCESS"
