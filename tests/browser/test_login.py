"""A console with users, over TLS: login, roles, and the throttle on guessing."""

import os
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest
import yaml
from playwright.sync_api import Browser, Page, expect

import programs
from browsers import narrated
from conftest import ports_of, site_data, tool, wait_until
from tms_config.config import load_site
from tms_runtime import environment
from tms_ur.access import hashed

pytestmark = [pytest.mark.turns, pytest.mark.ros, pytest.mark.browser]
LIMIT = 60.0  # s for whatever must happen at all
PASSWORD = "open-sesame"


@dataclass
class Server:
    """A `tms:ur`, and how it is lost and comes back."""

    url: str
    env: dict[str, str]
    log: Path
    process: programs.Program | None = None

    def start(self) -> None:
        self.log.unlink(missing_ok=True)  # of the one before it
        process = self.process = programs.process("tms:ur", self.env, self.log)
        ended = lambda: process.returncode is not None  # noqa: E731
        wait_until(lambda: ended() or "event=started" in self.log.read_text(), LIMIT, "tms:ur is up")
        assert not ended(), self.log.read_text()
        assert "users of console.users" in self.log.read_text()

    def kill(self) -> None:
        if self.process is not None:
            self.process.kill()
            self.process.wait(10)


@pytest.fixture
def server(own_domain: int, tmp_path: Path) -> Iterator[Server]:
    """A `tms:ur` of its own; nothing else of its site runs."""
    port = ports_of(own_domain)
    key, certificate = tmp_path / "key.pem", tmp_path / "certificate.pem"
    subprocess.run(
        [tool("openssl"), "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2", "-subj", "/CN=localhost",
         "-keyout", str(key), "-out", str(certificate)], check=True, capture_output=True,
    )  # fmt: skip
    users = tmp_path / "users.yaml"
    people = {name: {"role": name, "password": hashed(PASSWORD)} for name in ("viewer", "operator")}
    users.write_text(yaml.safe_dump({"users": people}))
    users.chmod(0o600)
    file = tmp_path / "site.yaml"
    tls = {"certificate": str(certificate), "key": str(key)}
    file.write_text(yaml.safe_dump(site_data(own_domain, port, console={"users": "users.yaml", "tls": tls})))
    hidden = ("ROS_DOMAIN_ID", "TMS_SITE", "TMS_STATE", "TMS_MONGODB_URI")
    clean = {name: value for name, value in os.environ.items() if name not in hidden}
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("TMS_STATE", str(tmp_path / "state"))
        patch.delenv("ROS_DOMAIN_ID", raising=False)
        env = {**clean, **environment.environment(load_site(str(file)))}
    (tmp_path / "state" / "ros").mkdir(parents=True)
    server = Server(f"https://localhost:{port + 90}", env, tmp_path / "log.txt")
    try:
        server.start()
        yield server
    finally:
        server.kill()


@pytest.fixture
def console(server: Server) -> str:
    """Its address."""
    return server.url


@pytest.fixture
def secure_page(chromium: Browser) -> Iterator[Page]:
    context = chromium.new_context(locale="en-GB", ignore_https_errors=True)
    yield narrated(context.new_page())
    context.close()


def login(page: Page, name: str, password: str) -> None:
    page.locator("#login_name").fill(name)
    page.locator("#login_password").fill(password)
    page.locator("#login button").click()


def test_login_roles_and_throttling(secure_page: Page, console: str) -> None:
    page = secure_page
    page.goto(console)
    expect(page.locator("#login")).to_be_visible()
    expect(page.locator("#stop")).to_be_hidden()
    login(page, "operator", PASSWORD)
    expect(page.locator("#who")).to_have_text("operator (operator)")
    expect(page.locator("#stop")).to_be_visible()
    cookies = page.context.cookies()
    assert [(one["httpOnly"], one["secure"], one["sameSite"]) for one in cookies] == [(True, True, "Strict")]

    page.reload()  # the session goes on
    expect(page.locator("#who")).to_have_text("operator (operator)")
    page.locator("#logout").click()
    expect(page.locator("#login")).to_be_visible()

    login(page, "viewer", PASSWORD)
    expect(page.locator("#who")).to_have_text("viewer (viewer)")
    expect(page.get_by_role("button", name="Software stop of zx200")).to_be_visible()
    expect(page.locator("main button.go")).to_have_count(0)
    refused = page.evaluate(
        "fetch('/api/runs', {method: 'POST', headers: {'Content-Type': 'application/json'}, "
        "body: JSON.stringify({task_id: 1})}).then(answer => answer.json())"
    )
    assert refused["code"] == "ROLE"
    page.locator("#logout").click()

    expect(page.locator("#login")).to_be_visible()
    for _ in range(4):
        login(page, "operator", "guess")
        expect(page.locator("#message")).to_have_text("the name or the password is wrong")
        page.locator("#message").evaluate("element => element.textContent = ''")
    login(page, "operator", "guess")
    expect(page.locator("#message")).to_contain_text("too many wrong passwords: try again in")


def test_a_session_that_ends_shows_the_login_and_a_panel_comes_back(secure_page: Page, console: str) -> None:
    page = secure_page
    page.clock.install()
    page.goto(f"{console}/panel.html?task=1")
    expect(page.locator("#login")).to_be_visible()
    login(page, "operator", PASSWORD)
    expect(page).to_have_url(f"{console}/panel.html?task=1")
    expect(page.locator("#stop")).to_be_visible()

    other = (
        page.context.new_page()
    )  # the same session: as a restart of the server would, it ends it unseen by the panel
    other.goto(console)
    other.locator("#logout").click()
    expect(other.locator("#login")).to_be_visible()
    expect(page).to_have_url(f"{console}/panel.html?task=1")
    page.clock.fast_forward(61_000)
    expect(page.locator("#login")).to_be_visible()


@pytest.mark.parametrize(
    ("path", "received"), [("", "#list_machines article"), ("/panel.html?task=1", "#state:not(:empty)")]
)
def test_a_stop_that_a_lost_session_has_swallowed_is_told(
    secure_page: Page, server: Server, path: str, received: str
) -> None:
    page, report, state = secure_page, secure_page.locator("#stop_report"), secure_page.locator(received)
    page.goto(server.url + path)
    login(page, "operator", PASSWORD)
    expect(state).to_be_visible()
    server.kill()
    expect(page.locator("#lost")).to_be_visible()
    page.locator("#stop").click()
    expect(report).to_contain_text("NOT STOPPED: The server cannot be reached.")
    server.start()  # which knows no session any more
    expect(page.locator("#login")).to_be_visible()
    expect(report).to_contain_text("NOT STOPPED: Your login ended before an answer to the stop came")
    login(page, "operator", PASSWORD)
    expect(state).to_be_visible()
    expect(report).to_contain_text("NOT STOPPED: The page was loaded anew")
    page.locator("#stop").click()
    expect(report).to_contain_text("zx200: STOP UNCONFIRMED")  # an answer, though nobody is there
    page.reload()
    expect(state).to_be_visible()
    expect(report).to_be_empty()
    page.context.clear_cookies()
    page.reload()
    expect(page.locator("#login")).to_be_visible()
    expect(report).to_be_empty()  # no more to tell
