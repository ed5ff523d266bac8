"""Roles, sessions, tokens, and the throttle on guessing passwords."""

from dataclasses import dataclass, field
from pathlib import Path

import pytest
import yaml

from tms_config.site_file import Console, Files
from tms_reason.errors import ConfigError
from tms_ur.access import SESSION_IDLE, Access, hashed
from unit.tms_ur.fakes import HERE, Client, FakeAudit, FakeSiteClient, app

START = ("/api/runs", {"task_id": 4})
STORE = ("/api/tasks", {"xml": "<root/>"})


@pytest.fixture(scope="session")
def users(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("ur") / "users.yaml"
    people = {
        "mina": {"role": "viewer", "password": hashed("mina-pass")},
        "ken": {"role": "operator", "password": hashed("ken-pass")},
        "root": {"role": "admin", "password": hashed("root-pass"), "token": hashed("root-token")},
    }
    file.write_text(yaml.safe_dump({"users": people}))
    file.chmod(0o600)
    return file


@dataclass
class Site:
    """An application with users and a clock that the test turns."""

    file: Path
    now: float = 1000.0
    site_client: FakeSiteClient = field(default_factory=FakeSiteClient)
    audit: FakeAudit = field(default_factory=FakeAudit)

    def __post_init__(self) -> None:
        self.client = Client(app(self.site_client, users=self.file, audit=self.audit, clock=lambda: self.now))

    def login(self, name: str, password: str) -> dict[str, str]:
        """Headers of the session."""
        answer = self.client.post("/api/login", json={"name": name, "password": password})
        assert answer.status_code == 200, answer.text
        return {"Cookie": answer.headers["set-cookie"].partition(";")[0]}


@pytest.fixture
def site(users: Path) -> Site:
    return Site(users)


def test_nothing_is_told_before_the_login(site: Site) -> None:
    for path in ("/api/state", "/api/events", "/api/tasks", "/api/site", "/api/audit"):
        answer = site.client.get(path)
        assert (answer.status_code, answer.json()["code"]) == (401, "LOGIN"), path
    assert site.client.post(*START[:1], json=START[1]).status_code == 401
    assert site.client.get("/").status_code == 200
    assert site.client.get("/api/session").json() == {"name": None, "role": None, "login": True}
    assert site.site_client.calls == []


@pytest.mark.parametrize(
    ("name", "role", "may_start", "may_store"),
    [("mina", "viewer", False, False), ("ken", "operator", True, False), ("root", "admin", True, True)],
)
def test_roles(site: Site, name: str, role: str, may_start: bool, may_store: bool) -> None:
    me = site.login(name, f"{name}-pass")
    assert site.client.get("/api/session", headers=me).json() == {"name": name, "role": role, "login": True}
    assert site.client.get("/api/tasks", headers=me).status_code == 200
    assert site.client.post("/api/stop", json={}, headers=me).status_code == 200  # everybody may stop
    for (path, body), may in ((START, may_start), (STORE, may_store)):
        answer = site.client.post(path, json=body, headers=me)
        assert answer.is_success == may, answer.text
        if not may:
            assert (answer.status_code, answer.json()["code"]) == (403, "ROLE")
            assert answer.json()["args"]["has"] == role


def test_cookie_is_out_of_reach(site: Site) -> None:
    answer = site.client.post("/api/login", json={"name": "ken", "password": "ken-pass"})
    cookie = answer.headers["set-cookie"]
    assert "HttpOnly" in cookie
    assert "SameSite=strict" in cookie
    assert "Secure" not in cookie  # there is no TLS here
    tls = Console(tls=Files(certificate=Path("c"), key=Path("k")))
    over_tls = Client(app(site.site_client, users=site.file, console=tls))
    answer = over_tls.post("/api/login", json={"name": "ken", "password": "ken-pass"})
    assert "Secure" in answer.headers["set-cookie"]


def test_sessions_end(site: Site) -> None:
    me = site.login("ken", "ken-pass")
    site.now += SESSION_IDLE - 1
    assert site.client.get("/api/state", headers=me).status_code == 200
    site.now += SESSION_IDLE + 1
    assert site.client.get("/api/state", headers=me).status_code == 401
    me = site.login("ken", "ken-pass")
    site.client.post("/api/logout", json={}, headers=me)
    assert site.client.get("/api/state", headers=me).status_code == 401
    assert site.client.get("/api/state", headers={"Cookie": "tms_session=made-up"}).status_code == 401


def test_foreign_pages_cannot_use_a_session(site: Site) -> None:
    me = site.login("root", "root-pass")
    answer = site.client.post(START[0], json=START[1], headers={**me, "Origin": "http://evil.example"})
    assert (answer.status_code, answer.json()["code"]) == (403, "FOREIGN_ORIGIN")
    assert site.client.post(START[0], json=START[1], headers={**me, "Origin": HERE}).status_code == 202


def test_tokens(site: Site) -> None:
    right = {"Authorization": "Bearer root:root-token"}
    for _ in range(2):  # the second one is known
        assert site.client.get("/api/state", headers=right).status_code == 200
    for wrong in ("root:root-pass", "root:", "ken:root-token", "nobody:x", "root-token"):
        answer = site.client.get("/api/state", headers={"Authorization": f"Bearer {wrong}"})
        assert answer.status_code in (401, 429), wrong


@pytest.mark.parametrize("name", ["ken", "nobody"])
def test_guessing_is_braked(site: Site, name: str) -> None:
    tries = [site.client.post("/api/login", json={"name": name, "password": f"guess-{n}"}) for n in range(6)]
    assert [answer.status_code for answer in tries] == [401, 401, 401, 401, 429, 429]
    assert int(tries[-1].headers["Retry-After"]) >= 1
    assert tries[-1].json()["args"]["seconds"] > 0
    site.now += 3
    answer = site.client.post("/api/login", json={"name": name, "password": "guess"})
    assert answer.status_code == 401  # and the wait is longer now
    refused = [refusal for refusal in site.audit.refusals if refusal[2] == "login_refused"]
    assert [why for *_, why in refused] == ["LOGIN"] * 4 + ["THROTTLED"] * 2 + ["LOGIN"]
    assert not any("guess" in part or "pass" in part for refusal in refused for part in refusal)


def test_the_right_password_waits_only_where_others_were_wrong(site: Site) -> None:
    right = {"name": "ken", "password": "ken-pass"}
    for _ in range(4):
        site.client.post("/api/login", json={"name": "ken", "password": "guess"})
    assert site.client.post("/api/login", json=right).status_code == 429
    other = Client(site.client.app, address="192.0.2.7")
    assert other.post("/api/login", json=right).status_code == 200
    site.now += 3
    assert site.client.post("/api/login", json=right).status_code == 200


def test_strangers_are_audited_where_they_command_or_guess(site: Site) -> None:
    site.client.get("/api/state")  # what a page does whose session is over
    assert site.audit.refusals == []
    site.client.post("/api/stop", json={})
    site.client.get("/api/state", headers={"Authorization": "Bearer root:wrong"})
    assert [why for *_, why in site.audit.refusals] == ["LOGIN", "LOGIN"]


def test_without_users_the_login_says_so() -> None:
    client = Client(app(FakeSiteClient()))
    assert client.get("/api/session").json() == {"name": "local", "role": "admin", "login": False}
    answer = client.post("/api/login", json={"name": "ken", "password": "x"})
    assert (answer.status_code, answer.json()["code"]) == (409, "NO_USERS")


def test_with_users_others_may_command(site: Site) -> None:
    client = Client(app(site.site_client, "0.0.0.0", users=site.file), base_url="http://192.0.2.1:8080")
    answer = client.post("/api/login", json={"name": "ken", "password": "ken-pass"})
    me = {"Cookie": answer.headers["set-cookie"].partition(";")[0]}
    assert client.post(START[0], json=START[1], headers=me).status_code == 202


def test_further_names(users: Path) -> None:
    client = Client(app(FakeSiteClient(), users=users, console=Console(names=("Site-PC.example",))))
    assert client.get("/api/session", headers={"Host": "site-pc.example:8080"}).status_code == 200
    assert client.get("/api/session", headers={"Host": "other.example"}).status_code == 400


@pytest.mark.parametrize(
    ("text", "mode", "part"),
    [
        (None, 0o600, "is not there"),
        ("users: {ken: {role: operator, password: secret}}", 0o600, "users.ken.password"),
        ("users: {ken: {role: boss, password: $argon2id$x}}", 0o600, "users.ken.role"),
        ("users: {ken: {role: operator}}", 0o600, "needs a password or a token"),
        ("users: {}", 0o644, "chmod 600"),
    ],
)
def test_bad_users_files(tmp_path: Path, text: str | None, mode: int, part: str) -> None:
    file = tmp_path / "users.yaml"
    if text is not None:
        file.write_text(text)
        file.chmod(mode)
    with pytest.raises(ConfigError, match=part) as error:
        Access(file)
    assert str(file) in str(error.value)
    assert "secret" not in str(error.value).replace("users.yaml", "")
