"""Where the console is, and its certificate beside the site file."""

import subprocess
from pathlib import Path
from typing import Any

import pytest

from tms_config.config import Site
from tms_config.site_file import SiteFile
from tms_reason.errors import ConfigError
from tms_ur import address

TLS = {"certificate": "cert.pem", "key": "key.pem"}


def file(bind: str = "127.0.0.1", **console: Any) -> SiteFile:
    facts = {"name": "yard", "domain": 1, "services": {}, "ports": {"console": 8443}}
    return SiteFile.model_validate({**facts, "bind": bind, "console": console})


def make_certificate(folder: Path) -> None:
    subprocess.run(
        ["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2", "-subj", "/CN=localhost",
         "-keyout", str(folder / "key.pem"), "-out", str(folder / "cert.pem")], check=True, capture_output=True,
    )  # fmt: skip


@pytest.fixture
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Site:
    """Its files are in a folder; somebody starts it from another one."""
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    monkeypatch.chdir(elsewhere)
    return Site(tmp_path / "yard.yaml", file(tls=TLS), {}, tmp_path / "state")


@pytest.mark.parametrize(
    ("bind", "tls", "wanted"),
    [
        ("127.0.0.1", None, "http://127.0.0.1:8443"),
        ("0.0.0.0", None, "http://127.0.0.1:8443"),  # nobody can open http://0.0.0.0
        ("0.0.0.0", TLS, "https://127.0.0.1:8443"),
        ("192.0.2.7", TLS, "https://192.0.2.7:8443"),
        ("::", None, "http://[::1]:8443"),
        ("site-pc", None, "http://site-pc:8443"),
    ],
)
def test_a_browser_can_open_it(bind: str, tls: dict[str, str] | None, wanted: str) -> None:
    assert address.url(file(bind, tls=tls)) == wanted


def test_the_certificate_is_beside_the_site_file(site: Site, tmp_path: Path) -> None:
    make_certificate(tmp_path)
    found = address.certificate(site)
    assert found is not None
    assert (found.certificate, found.key) == (tmp_path / "cert.pem", tmp_path / "key.pem")


def test_a_site_without_tls_has_none(tmp_path: Path) -> None:
    assert address.certificate(Site(tmp_path / "yard.yaml", file(), {}, tmp_path / "state")) is None


@pytest.mark.parametrize(("name", "key"), [("cert.pem", "certificate"), ("key.pem", "key")])
def test_a_missing_file_is_named(site: Site, tmp_path: Path, name: str, key: str) -> None:
    make_certificate(tmp_path)
    (tmp_path / name).unlink()
    with pytest.raises(ConfigError, match=rf"console\.tls\.{key}: {tmp_path}/{name}: cannot be read"):
        address.certificate(site)


def test_files_that_do_not_belong_together_are_refused(site: Site, tmp_path: Path) -> None:
    make_certificate(tmp_path)
    other = (tmp_path / "key.pem").read_text()
    make_certificate(tmp_path)
    (tmp_path / "key.pem").write_text(other)
    with pytest.raises(ConfigError, match="are no PEM certificate, key"):
        address.certificate(site)
    (tmp_path / "key.pem").write_text("nonsense")
    with pytest.raises(ConfigError, match="are no PEM certificate, key"):
        address.certificate(site)


def test_a_key_with_a_password_is_refused_and_not_asked_for(site: Site, tmp_path: Path) -> None:
    make_certificate(tmp_path)
    words = ["openssl", "rsa", "-aes128", "-passout", "pass:secret", "-in", "key.pem", "-out", "key.pem"]
    subprocess.run(words, cwd=tmp_path, check=True, capture_output=True)
    with pytest.raises(ConfigError, match="are no PEM certificate, key"):
        address.certificate(site)


def users_of(tmp_path: Path, text: str | None, mode: int = 0o600) -> Site:
    """A site whose users file holds `text`; it is not there for None."""
    if text is not None:
        (tmp_path / "users.yaml").write_text(text)
        (tmp_path / "users.yaml").chmod(mode)
    return Site(tmp_path / "yard.yaml", file(users="users.yaml"), {}, tmp_path / "state")


def test_the_users_file_is_beside_the_site_file(tmp_path: Path) -> None:
    hashed = "$argon2id$v=19$m=8,t=1,p=1$c2FsdHNhbHQ$aGFzaGhhc2g"
    text = f"users: {{ken: {{role: operator, password: '{hashed}'}}}}\n"
    assert address.users(users_of(tmp_path, text)) == tmp_path / "users.yaml"
    assert address.users(Site(tmp_path / "yard.yaml", file(), {}, tmp_path / "state")) is None


@pytest.mark.parametrize(
    ("text", "mode", "reported"),
    [
        (None, 0, r"is not there; Add its users: `tms user add NAME --role admin`"),
        ("users: {}\n", 0o644, r"all users of this PC may read it: `chmod 600 "),
        ("users: {ken: {role: boss}}\n", 0o600, r"users\.yaml:1: users\.ken\.role: "),
        (
            "users: {ken: {role: viewer}}\n",
            0o600,
            r"users\.yaml:1: users\.ken: needs a password or a token: `tms user add`",
        ),
        ('users: {"k\\0n": {role: viewer, token: $argon2id$x}}\n', 0o600, "holds the control character U\\+0000"),
        ("users: [\n", 0o600, r"users\.yaml:2: "),
    ],
)
def test_a_users_file_that_does_not_do_is_told(tmp_path: Path, text: str | None, mode: int, reported: str) -> None:
    with pytest.raises(ConfigError, match=reported):
        address.users(users_of(tmp_path, text, mode))


def test_a_users_file_that_cannot_be_reached_is_told(tmp_path: Path) -> None:
    site = users_of(tmp_path, "users: {}\n")
    (tmp_path / "users.yaml").rename(tmp_path / "folder")
    (tmp_path / "users.yaml").mkdir()
    with pytest.raises(ConfigError, match=r"users\.yaml: cannot be read \(Is a directory\)"):
        address.users(site)
    (tmp_path / "users.yaml").rmdir()
    (tmp_path / "users.yaml").symlink_to("users.yaml")
    with pytest.raises(ConfigError, match=r"console\.users cannot be read \(Too many levels"):
        address.users(site)
