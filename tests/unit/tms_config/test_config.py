"""Configuration errors name the file, the key and what is wrong."""

import re
from pathlib import Path

import pytest
import yaml

from conftest import site_data
from tms_config.config import load_site
from tms_config.models import MachineModel
from tms_config.processes import find, table
from tms_config.yaml_file import parse, read_yaml
from tms_reason.errors import ConfigError


def site(folder: Path, **changes: object) -> str:
    file = folder / "site.yaml"
    file.write_text(yaml.safe_dump(site_data(50, 20000, **changes)))
    return str(file)


@pytest.fixture(autouse=True)
def clean_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("ROS_DOMAIN_ID", "TMS_SITE", "TMS_STATE", "TMS_MONGODB_URI"):
        monkeypatch.delenv(name, raising=False)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"colour": "red"}, "colour: unknown key"),
        ({"ports": {"metric": 9000}}, "ports.metric: unknown key"),
        ({"domain": 102}, "domain: "),
        ({"domain": "many"}, "domain: "),
        ({"machines": {"zx200": {"model": "zx999"}}}, "no model 'zx999' (there: "),
        ({"machines": {"ZX200": {"model": "zx200"}}}, "machines.ZX200"),
        ({"machines": {"zx 200": {"model": "zx200"}}}, "machines.zx 200"),
        ({"sim": {"speed": 0}}, "sim.speed: "),
        ({"backend": "real"}, "backend: "),
    ],
)
def test_wrong_site(tmp_path: Path, changes: dict[str, object], said: str) -> None:
    with pytest.raises(ConfigError) as caught:
        load_site(site(tmp_path, **changes))
    assert said in str(caught.value)
    assert str(tmp_path / "site.yaml") in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("a: 1\na: 2\n", ":2: key 'a' is there twice"),
        ("a: [1\n", ":2: "),
        ("a: \x07\n", ": unacceptable character #x0007: control characters are not allowed"),
        ("a: !!python/object:os.system {}\n", ":1: "),
    ],
)
def test_wrong_yaml(tmp_path: Path, text: str, said: str) -> None:
    file = tmp_path / "x.yaml"
    file.write_text(text)
    with pytest.raises(ConfigError) as caught:
        read_yaml(file)
    assert f"{file}{said}" in str(caught.value)


def test_missing_and_binary_files(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="cannot be read"):
        load_site(str(tmp_path / "none.yaml"))
    file = tmp_path / "bytes.yaml"
    file.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ConfigError, match="UTF-8"):
        parse(file, MachineModel)


def test_environment_wins_over_the_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "7")
    monkeypatch.setenv("TMS_STATE", str(tmp_path / "s"))
    loaded = load_site(site(tmp_path))
    assert (loaded.domain, loaded.state) == (7, tmp_path / "s")
    monkeypatch.setenv("ROS_DOMAIN_ID", "200")
    with pytest.raises(ConfigError, match="ROS_DOMAIN_ID is '200'"):
        load_site(site(tmp_path))


def test_a_password_comes_only_from_the_environment(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert load_site(site(tmp_path)).store_uri == "mongodb://127.0.0.1:20091/?directConnection=true"
    monkeypatch.setenv("TMS_MONGODB_URI", "mongodb://u:p@db/")
    loaded = load_site(site(tmp_path))
    assert loaded.store_uri == "mongodb://u:p@db/"
    assert not any(row.name == "store" for row in table(loaded))


URI = "mongodb://db1,db2:27018"


def test_a_mongodb_with_user_password_and_tls(tmp_path: Path) -> None:
    (tmp_path / "password").write_text("p@ss/w:rd%\n")
    login = {"kind": "mongodb", "user": "t ms", "password_file": "password"}
    for given, wanted in (
        ({"uri": URI, **login}, "mongodb://t%20ms:p%40ss%2Fw%3Ard%25@db1,db2:27018"),
        ({"uri": f"{URI}/?replicaSet=rs0", "tls_ca": "/etc/ca.pem"},
         f"{URI}/?replicaSet=rs0&tls=true&tlsCAFile=%2Fetc%2Fca.pem"),
        ({"uri": f"{URI}/", "tls_ca": "/a", "tls_certificate": "/b"},
         f"{URI}/?tls=true&tlsCAFile=%2Fa&tlsCertificateKeyFile=%2Fb"),
        ({"uri": URI, "tls_ca": "/a"}, f"{URI}/?tls=true&tlsCAFile=%2Fa"),
    ):  # fmt: skip
        assert load_site(site(tmp_path, store=given)).store_uri == wanted


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"uri": "mongodb://anna:s3cret@db1"}, "store: uri holds a password: write user and password_file"),
        ({"uri": URI, "user": "anna"}, "store: user and password_file go together"),
        ({"uri": URI, "password_file": "x"}, "store: user and password_file go together"),
        ({"user": "anna", "password_file": "x"}, "store: user, password_file and TLS need the uri"),
        ({"tls_ca": "x"}, "store: user, password_file and TLS need the uri"),
        ({"uri": "mongodb://anna@db1", "user": "anna", "password_file": "x"}, "store: the user stands in uri and"),
    ],
)
def test_what_a_site_may_not_say_about_its_store(tmp_path: Path, given: dict[str, object], said: str) -> None:
    with pytest.raises(ConfigError, match=re.escape(said)) as caught:
        load_site(site(tmp_path, store=given))
    assert "s3cret" not in str(caught.value)


@pytest.mark.parametrize(
    ("content", "said"), [(None, "cannot be read"), (b"\n", "is empty"), (b"\xff\xfe", "is no UTF-8 text")]
)
def test_a_password_file_that_is_of_no_use(tmp_path: Path, content: bytes | None, said: str) -> None:
    if content is not None:
        (tmp_path / "password").write_bytes(content)
    loaded = load_site(site(tmp_path, store={"uri": URI, "user": "anna", "password_file": "password"}))
    with pytest.raises(ConfigError, match=rf"store\.password_file: .*{said}"):
        _ = loaded.store_uri


def test_the_backend_chooses_the_names(tmp_path: Path) -> None:
    machines = {"zx200": {"model": "zx200"}, "ic120_1": {"model": "ic120"}, "ic120_2": {"model": "ic120"}}
    names = {
        backend: load_site(site(tmp_path, machines=machines, backend=backend)) for backend in ("sim", "opera", "physx")
    }
    assert [names[one].border("zx200").joint_states for one in names] == ["joint_states", "joint_states", "joint_state"]
    assert names["physx"].border("ic120_2").cmd_vel == "tracks/cmd_vel"
    assert {names["sim"].border(f"ic120_{i}").frame_prefix for i in (1, 2)} == {"ic120_1_tf/", "ic120_2_tf/"}
    as_physx = load_site(site(tmp_path, machines=machines, sim={"names": "physx"}))
    assert as_physx.border("zx200") == names["physx"].border("zx200")
    assert any(row.full == "sim:zx200" for row in table(as_physx))


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"backend": "opera", "machines": {"a": {"model": "zx200"}, "b": {"model": "zx200"}}}, "a and b would share"),
        ({"sim": {"faults": {"ic120": {"late": 1}}}}, "sim.faults.ic120: no such machine (there: zx200)"),
        ({"sim": {"faults": {"zx200": {"lat": 1}}}}, "sim.faults.zx200.lat: unknown key"),
        ({"backend": "physx", "machines": {"d": {"model": "d37pxi"}}}, "nothing for backend 'physx'"),
    ],
)
def test_machines_that_do_not_fit(tmp_path: Path, changes: dict[str, object], said: str) -> None:
    with pytest.raises(ConfigError, match=re.escape(said)):
        load_site(site(tmp_path, **changes))


def test_one_line_adds_a_machine(tmp_path: Path) -> None:
    machines = {"zx200": {"model": "zx200"}, "zx200_2": {"model": "zx200"}}
    names = {row.full for row in table(load_site(site(tmp_path, machines=machines)))}
    assert {"zx200_2:rc", "zx200_2:rp", "sim:zx200_2", "zx200_2:subtask_zx200_change_pose"} <= names


@pytest.mark.parametrize(
    ("name", "full"),
    [("zx200:rc", "zx200:rc"), ("change_pose", "zx200:subtask_zx200_change_pose"), ("zx200:change_pose",
     "zx200:subtask_zx200_change_pose"), ("db", "tms:db")],
)  # fmt: skip
def test_a_part_of_a_name_is_enough(tmp_path: Path, name: str, full: str) -> None:
    assert find(load_site(site(tmp_path)), name).full == full


def test_names_that_fit_none_or_several(tmp_path: Path) -> None:
    loaded = load_site(site(tmp_path))
    with pytest.raises(
        ConfigError, match="fits zx200:subtask_zx200_excavate_simple, zx200:subtask_zx200_excavate_simple_plan"
    ):
        find(loaded, "simple")
    with pytest.raises(ConfigError, match="did you mean zx200:rc"):
        find(loaded, "zx20:rc")


def test_unknown_service(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"services\.dbx: unknown"):
        table(load_site(site(tmp_path, services={"dbx": {}})))


def test_a_secret_can_come_from_a_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    secret = tmp_path / "uri"
    secret.write_text("mongodb://u:p@db/\n")
    monkeypatch.setenv("TMS_MONGODB_URI_FILE", str(secret))
    loaded = load_site(site(tmp_path))
    assert loaded.store_uri == "mongodb://u:p@db/" and not loaded.embedded_store
    secret.unlink()
    with pytest.raises(ConfigError, match=r"TMS_MONGODB_URI_FILE: .*cannot be read"):
        _ = loaded.store_uri


def test_the_bridge_has_settings_of_its_own(tmp_path: Path) -> None:
    text = "name: t\ndomain: 1\nservices: {if: %s}\n"
    file = tmp_path / "site.yaml"
    file.write_text(text % "{}")
    bridge = load_site(str(file)).bridge
    assert (bridge.bind, bridge.port, bridge.joint_cmd, bridge.role) == ("127.0.0.1", 10000, "plain", "sim")
    for settings, said in (("{port: 80}", "if.port: "), ("{colour: red}", "if.colour: unknown key"),
                           ("{joint_cmd: both}", "if.joint_cmd: ")):  # fmt: skip
        file.write_text(text % settings)
        with pytest.raises(ConfigError, match=said):
            load_site(str(file))
