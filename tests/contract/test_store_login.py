"""A store that wants TLS, a user and a password, as a site's MongoDB does; the embedded store can do both."""

import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
import yaml

from stores import Server
from tms_config.config import load_site
from tms_db import schema, store, store_address
from tms_reason.errors import DbError

PASSWORD = "p@ss/w:rd%"
PARTS: dict[str, object] = {
    "uri": "mongodb://{host}", "user": "tms", "password_file": "password", "tls_ca": "ca.pem",
}  # fmt: skip


def openssl(folder: Path, *words: str) -> None:
    subprocess.run(["openssl", *words], cwd=folder, check=True, capture_output=True, timeout=30)


def certificates(folder: Path) -> None:
    """An authority, a server's certificate that it signed, and another authority."""
    new = ("-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes")
    for name in ("ca", "other"):
        openssl(folder, "req", "-x509", *new, "-keyout", f"{name}.key", "-out", f"{name}.pem", "-subj", f"/CN={name}")
    openssl(folder, "req", *new, "-keyout", "server.key", "-out", "server.csr", "-subj", "/CN=store")
    (folder / "names").write_text("subjectAltName=IP:127.0.0.1")
    openssl(folder, "x509", "-req", "-in", "server.csr", "-CA", "ca.pem", "-CAkey", "ca.key", "-CAcreateserial",
            "-extfile", "names", "-out", "server.pem")  # fmt: skip


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("login")
    certificates(folder)
    (folder / "password").write_text(PASSWORD + "\n")
    (folder / "wrong").write_text("another\n")
    return folder


@pytest.fixture(scope="module")
def guarded(folder: Path, program: None) -> Iterator[Server]:
    server = Server(folder / "store")
    db = server.open()
    db.client["admin"].command("createUser", "tms", pwd=PASSWORD, roles=["root"])
    db.client.close()
    server.end()
    certificate = [f"--tls-cert-file={folder / 'server.pem'}", f"--tls-key-file={folder / 'server.key'}"]
    server.more = ["--auth", *certificate]
    server.start()
    yield server
    server.end(kill=True)


@pytest.fixture
def attempt(folder: Path, guarded: Server, monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[..., int]]:
    """Open the database of a site whose `store:` has these changes; the schema's version then."""
    monkeypatch.delenv("TMS_MONGODB_URI", raising=False)
    opened: list[store.Db] = []

    def attempt(**changes: object) -> int:
        given = {key: value for key, value in {**PARTS, **changes}.items() if value is not None}
        given["uri"] = str(given["uri"]).format(host=f"127.0.0.1:{guarded.port}")
        site = {"name": "t", "domain": 43, "services": {"db": {}}, "store": {"kind": "mongodb", **given}}
        (folder / "site.yaml").write_text(yaml.safe_dump(site))
        opened.append(store.connect(store_address.uri(load_site(str(folder / "site.yaml"))), "rostmsdb"))
        schema.bring_up(opened[-1])
        return schema.stored(opened[-1])

    yield attempt
    for db in opened:
        db.client.close()


def test_a_site_logs_in_over_tls(attempt: Callable[..., int]) -> None:
    assert attempt() == schema.NEWEST
    assert attempt(uri="mongodb://{host}/?replicaSet=secantus") == schema.NEWEST


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"password_file": "wrong"}, "refuses our login: check user and password"),
        ({"user": None, "password_file": None}, "refuses our login"),
        ({"tls_ca": "other.pem"}, "store.tls_ca does not vouch for its certificate"),
        ({"tls_ca": None}, "does not answer"),
        ({"uri": "mongodb://{host}/?replicaSet=rs0"}, "none of its hosts is a member of the replica set"),
    ],
)
def test_what_keeps_a_site_out_is_told(attempt: Callable[..., int], changes: dict[str, object], says: str) -> None:
    with pytest.raises(DbError, match=says) as caught:
        attempt(**changes)
    assert caught.value.code == "STORE_DOWN"
    error: BaseException | None = caught.value
    while error is not None:
        assert PASSWORD not in str(error)
        error = error.__cause__
