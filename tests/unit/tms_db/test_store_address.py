"""How the database module comes to the address of its store, and to the password in it."""

from pathlib import Path

import pytest
import yaml

from conftest import site_data
from tms_config.config import Site, load_site
from tms_config.processes import table
from tms_config.reasons import BadFile, BadKey, BadVariable, CannotBeRead, NotUtf8
from tms_db import store_address
from tms_db.reasons import EmptyFile
from tms_reason.errors import ConfigError
from tms_reason.reason import Reason

URI = "mongodb://db1,db2:27018"


@pytest.fixture(autouse=True)
def clean_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("ROS_DOMAIN_ID", "TMS_SITE", "TMS_STATE", "TMS_MONGODB_URI"):
        monkeypatch.delenv(name, raising=False)


def site(folder: Path, **changes: object) -> Site:
    file = folder / "site.yaml"
    file.write_text(yaml.safe_dump(site_data(50, 20000, **changes)))
    return load_site(str(file))


def test_a_password_comes_only_from_the_environment(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert store_address.uri(site(tmp_path)) == "mongodb://127.0.0.1:20091/?directConnection=true"
    monkeypatch.setenv("TMS_MONGODB_URI", "mongodb://u:p@db/")
    loaded = site(tmp_path)
    assert store_address.uri(loaded) == "mongodb://u:p@db/"
    assert not any(row.name == "store" for row in table(loaded))


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
        assert store_address.uri(site(tmp_path, store=given)) == wanted


@pytest.mark.parametrize(
    ("content", "problem"),
    [(None, CannotBeRead("No such file or directory")), (b"\n", EmptyFile()), (b"\xff\xfe", NotUtf8())],
)
def test_a_password_file_that_is_of_no_use(tmp_path: Path, content: bytes | None, problem: Reason) -> None:
    file = tmp_path / "password"
    if content is not None:
        file.write_bytes(content)
    loaded = site(tmp_path, store={"uri": URI, "user": "anna", "password_file": "password"})
    with pytest.raises(ConfigError) as caught:
        _ = store_address.uri(loaded)
    found = caught.value.reason
    assert isinstance(found, BadKey)
    assert (found.key, found.problem) == ("store.password_file", BadFile(str(file), problem))


def test_a_secret_can_come_from_a_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    secret = tmp_path / "uri"
    secret.write_text("mongodb://u:p@db/\n")
    monkeypatch.setenv("TMS_MONGODB_URI_FILE", str(secret))
    loaded = site(tmp_path)
    assert store_address.uri(loaded) == "mongodb://u:p@db/" and not loaded.embedded_store
    secret.unlink()
    with pytest.raises(ConfigError) as caught:
        _ = store_address.uri(loaded)
    problem = BadFile(str(secret), CannotBeRead("No such file or directory"))
    assert caught.value.reason == BadVariable("TMS_MONGODB_URI_FILE", problem)
