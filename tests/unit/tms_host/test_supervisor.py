"""supervisord's configuration is rendered from the process table; paths cannot break it."""

import configparser
from pathlib import Path

import pytest
import yaml

from conftest import site_data
from tms_core.config import Site, load_site
from tms_core.errors import ConfigError
from tms_core.processes import table
from tms_host.supervisor import Supervisor, SupervisorDown, render, runtime_folder, socket_path


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
