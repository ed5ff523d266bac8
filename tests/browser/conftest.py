"""A real headless Chromium in front of the console of the session's mesh; screenshots are kept as artefacts."""

import re
from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser, Page, expect

import browsers
from browsers import LIMIT, ask, narrated
from conftest import PROJECT, Mesh, wait_until

SHOTS = PROJECT / ".state" / "screenshots"


@pytest.fixture(scope="module")
def chromium() -> Iterator[Browser]:
    expect.set_options(timeout=LIMIT * 1000)
    with browsers.chromium() as browser:
        yield browser


@pytest.fixture(scope="module")
def address(first_port: int) -> str:
    return f"http://127.0.0.1:{first_port + 90}"


@pytest.fixture
def page(chromium: Browser, request: pytest.FixtureRequest) -> Iterator[Page]:
    """An empty page of a tablet in English; what it looks like at the end is kept, and no script may have failed."""
    context = chromium.new_context(viewport={"width": 1280, "height": 800}, locale="en-GB")
    context.set_default_timeout(LIMIT * 1000)
    page = narrated(context.new_page())
    problems: list[str] = []
    page.on("pageerror", lambda error: problems.append(str(error)))
    yield page
    SHOTS.mkdir(parents=True, exist_ok=True)
    page.screenshot(path=str(SHOTS / f"{re.sub(r'[^0-9A-Za-z_]+', '_', request.node.name)}.png"))
    context.close()
    assert problems == []


@pytest.fixture
def idle(mesh: Mesh, address: str) -> Iterator[Mesh]:
    """The mesh, in which nothing runs before and after the test, and whose machine is armed."""
    _tidy(address)
    yield mesh
    _tidy(address)


def _tidy(address: str) -> None:
    for run in ask(address, "/api/state")["runs"]:
        ask(address, f"/api/runs/{run['run_id']}/cancel", {})
    wait_until(lambda: not ask(address, "/api/state")["runs"], LIMIT, "no run is active")
    wait_until(lambda: _armed(address), LIMIT, "zx200 stands and is armed")


def _armed(address: str) -> bool:
    """Whether the machine can begin a run; re-arms it. A console that was just started does not know it yet."""
    machine = ask(address, "/api/state")["machines"][0]
    if machine["latch"]:
        first = ask(address, "/api/machines/zx200/rearm", {})
        ask(address, "/api/machines/zx200/rearm", {"token": first["token"]})
        return False
    return bool(machine["state"] == "standing")
