"""What `tms up` and `tms check` do before anything starts."""

import json
import os
from pathlib import Path
from typing import Any

import pytest
import yaml

from conftest import site_data
from tms_cli import mesh
from tms_cli.commands import check
from tms_config.config import Site, load_site
from tms_machine.reasons import WaitingFor
from tms_rc.reasons import AreasNotEnabled
from tms_reason.errors import ConfigError, TmsError
from tms_reason.reason import Reason

PCS = {
    "cps": {"address": "127.0.0.1", "roles": ["cps", "machine", "sim"]},
    "sensing": {"address": "127.0.0.1"},
}
TLS = {"tls": {"certificate": "cert.pem", "key": "key.pem"}}


@pytest.fixture(autouse=True)
def state(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TMS_STATE", str(tmp_path / "state"))
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    for name in ("ROS_DOMAIN_ID", "TMS_ALERTS_TO", "TMS_PC"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(mesh, "_start", lambda *_: pytest.fail("something was started"))


def site(folder: Path, **changes: Any) -> Site:
    file = folder / "site.yaml"
    file.write_text(yaml.safe_dump({**site_data(51, 21000), **changes}))
    return load_site(str(file))


@pytest.mark.parametrize("to", [None, "127.0.0.1:9093"])
def test_alerts_go_where_the_environment_says(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, to: str | None) -> None:
    ours = site(tmp_path)
    monkeypatch.setattr(mesh, "check", lambda _: ())
    monkeypatch.setattr(mesh.Supervisor, "alive", lambda _: True)  # it runs already, so nothing is started
    if to:
        monkeypatch.setenv("TMS_ALERTS_TO", to)
    (tmp_path / "state").mkdir()
    assert mesh.up(ours) is False
    written = json.loads((tmp_path / "state" / "prometheus" / "alertmanagers.json").read_text())
    assert written == ([{"targets": [to]}] if to else [])


@pytest.mark.parametrize("left_open", [True, False])
def test_the_state_of_an_older_release_is_closed_with_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], left_open: bool
) -> None:
    ours, folder = site(tmp_path, store={"kind": "mongodb", "uri": "mongodb://x/"}), tmp_path / "state"
    monkeypatch.setattr(mesh.Supervisor, "alive", lambda _: True)  # it runs already, so nothing is started
    if left_open:
        (folder / "log").mkdir(parents=True)
        (folder / "log" / "zx200.rc.log").touch()
        for path, mode in ((folder, 0o755), (folder / "log", 0o755), (folder / "log" / "zx200.rc.log", 0o644)):
            path.chmod(mode)
    assert mesh.up(ours) is False
    assert [path for path in (folder, *folder.rglob("*")) if path.stat().st_mode & 0o077] == []
    reported = f"{folder}: closed 3 files to other users\n" if left_open else ""
    assert capsys.readouterr().err == reported


def test_prometheus_reads_a_folder_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its own user may not look into the state folder."""
    ours, folder = site(tmp_path, store={"kind": "mongodb", "uri": "mongodb://x/"}), tmp_path / "for" / "prometheus"
    monkeypatch.setattr(mesh.Supervisor, "alive", lambda _: True)
    monkeypatch.setenv("TMS_PROMETHEUS", str(folder))
    mesh.up(ours)
    modes = {path.name: path.stat().st_mode & 0o777 for path in (folder, *folder.iterdir())}
    assert modes == {
        "prometheus": 0o755, "prometheus.yml": 0o644, "rules.yml": 0o644, "targets.json": 0o644,
        "alertmanagers.json": 0o644,
    }  # fmt: skip
    assert folder.parent.stat().st_mode & 0o005 == 0o005
    assert not (tmp_path / "state" / "prometheus").exists()


def test_a_console_without_its_certificate_is_told_before_anything_starts(tmp_path: Path, tms: Any) -> None:
    ours = site(tmp_path, console=TLS, store={"kind": "mongodb", "uri": "mongodb://x/"})
    with pytest.raises(ConfigError, match=rf"console\.tls\.certificate: {tmp_path}/cert.pem: cannot be read"):
        mesh.up(ours)
    assert "console.tls.certificate" in str(tms(check.command, "--site", ours.path).exception)
    assert not (tmp_path / "state" / "supervisord.conf").exists()


@pytest.mark.parametrize(
    ("text", "reported"),
    [
        (None, "is not there; Add its users: `tms user add"),
        ("users: {}\n", "all users of this PC may read it"),
        ("user: 1\n", "user"),
    ],
)
def test_users_that_the_console_cannot_take_are_told_before_anything_starts(
    tmp_path: Path, tms: Any, text: str | None, reported: str
) -> None:
    file = tmp_path / "users.yaml"
    if text is not None:
        file.write_text(text)
        file.chmod(0o644 if "users" in text else 0o600)
    ours = site(tmp_path, console={"users": "users.yaml"}, store={"kind": "mongodb", "uri": "mongodb://x/"})
    with pytest.raises(ConfigError, match=f"{file}(:1)?: .*{reported}"):
        mesh.up(ours)
    assert reported in str(tms(check.command, "--site", ours.path).exception)
    assert not (tmp_path / "state" / "supervisord.conf").exists()


def test_a_pc_without_the_console_needs_none(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, tms: Any) -> None:
    facts = {"console": {**TLS, "users": "users.yaml"}, "store": {"kind": "mongodb", "uri": "mongodb://x/"}, "pcs": PCS}
    monkeypatch.setenv("TMS_PC", "cps")
    assert "console.tls.certificate" in str(tms(check.command, "--site", site(tmp_path, **facts).path).exception)
    for other in ("sensing", ""):  # the other one, or one that nobody has chosen yet
        monkeypatch.setenv("TMS_PC", other)
        assert tms(check.command, "--site", site(tmp_path, **facts).path).exit_code == 0
    monkeypatch.setenv("TMS_PC", "sensing")
    mesh.check(site(tmp_path, **facts))


def test_a_group_that_the_caller_runs_itself_is_left_out(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    ours, started = site(tmp_path, store={"kind": "mongodb", "uri": "mongodb://x/"}), []
    monkeypatch.setattr(mesh.Supervisor, "alive", lambda _: bool(started))
    monkeypatch.setattr(mesh.Supervisor, "pid", lambda _: os.getpid())
    monkeypatch.setattr(mesh, "_start", lambda _, conf: started.append(conf.read_text()))
    assert mesh.up(ours, without="sim") is True
    assert "tms_runtime.run zx200:rc\n" in started[0] and "tms_runtime.run sim:" not in started[0]


def test_a_gateway_whose_areas_nobody_has_enabled_is_told_and_not_waited_for(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Only a person can help, with the mesh that has just started."""
    told = list[str]()
    lacks: dict[str, Reason] = {"zx200:rc": AreasNotEnabled()}
    monkeypatch.setattr(mesh, "ENABLED_LATE", 0.05)
    monkeypatch.setattr(mesh.metrics, "unready", lambda row: lacks.get(row.full))
    ours = site(tmp_path)
    mesh.wait_ready(ours, told.append)
    assert any(one.startswith("zx200:rc waits: no areas are enabled for this site; Look") for one in told)
    assert "tms:ts ready" in told
    lacks["tms:ts"] = WaitingFor("tms:db")
    monkeypatch.setattr(mesh, "READY_LIMIT", 0.2)
    with pytest.raises(TmsError, match="tms:ts is not ready"):
        mesh.wait_ready(ours, told.append)
