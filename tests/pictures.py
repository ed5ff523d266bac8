"""`make pictures`: every page of the console of the running demo, as deploy/pictures/<page>.png, some in Japanese, too.

The task of the newest run that succeeded is run once more, so that there is something to see on the pages of what goes
on now. It is left to end by itself.
"""

from __future__ import annotations

import sys
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

from PIL import Image
from playwright.sync_api import TimeoutError, ViewportSize

from browsers import Refused, ask, chromium
from tms_config.config import PROJECT, load_site
from tms_reason.errors import TmsError
from tms_ur import address

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

PICTURES = PROJECT / "deploy" / "pictures"
SIZE = ViewportSize(width=1280, height=800)  # px
LARGEST = 150_000  # bytes of a picture
LIMIT = 60.0  # s for whatever must happen at all
RUN_LIMIT = 600.0  # s for the run to end
LOCALES = {"": "en-GB", ".ja": "ja-JP"}  # of the browser, by what the file's name ends with
JAPANESE = {"board", "tree", "map"}  # pages, those of README.ja.md
# What a page must show before its picture is taken; one that is not named here has a heading.
SHOWN = {
    "board": ("#list_active li", "#list_tasks li", "#list_machines .card"),
    "tree": ("#tree_box [data-state=running]",),
    "map": ("#map_box [data-machine]", "#arms svg"),
    "history": ("#list_history tr", "#past [data-path]"),
    "data": ("#list_records tr", "#list_sensing tr"),
    "system": ("#list_processes tr",),
    "tasks": ("#list_stored tr",),
}


class NoPictures(Exception):
    """Why there are none, in one line."""


def finished_run(url: str) -> Any:
    """The newest run that succeeded, on a console that may be pictured."""
    try:
        session = ask(url, "/api/session")
    except (Refused, OSError, ValueError) as error:  # nobody is there, or something else
        raise NoPictures(f"no console answers at {url}: `make demo` first") from error
    if session["login"]:
        raise NoPictures(f"{url} has users; only a console without them, as the demo's, is pictured")
    site = ask(url, "/api/site")
    if site["backend"] != "sim":
        raise NoPictures(f"the machines of {site['name']} are not stand-ins: a run for a picture would move them")
    done = next((run for run in ask(url, "/api/runs?limit=50") if run["state"] == "success"), None)
    if done is None:
        raise NoPictures("no run has succeeded here: `make demo` first")
    return done


def start(url: str, task: int) -> None:
    """Run a task; returns when it has begun."""
    try:
        ask(url, "/api/runs", {"task_id": task})
    except Refused as error:
        raise NoPictures(f"task {task} does not run: {error}") from error


def open_page(page: Page, url: str, place: str) -> None:
    """Show a page (`history`, or `history/RUN`) with what it is about."""
    name = place.partition("/")[0]
    page.goto(f"{url}/#{place}")
    page.wait_for_selector("#connecting", state="hidden")
    for selector in (f"#page[data-page={name}]", *SHOWN.get(name, ("#page h2",))):
        try:
            page.wait_for_selector(selector, state="attached")
        except TimeoutError as error:
            raise NoPictures(f"the page {place} shows no {selector} within {LIMIT:.0f} s") from error


def keep(png: bytes, file: Path) -> None:
    """Keep a picture with the 256 colours that suit it best."""
    with Image.open(BytesIO(png)) as picture:
        picture.convert("RGB").quantize().save(file, optimize=True)
    size = file.stat().st_size
    if size > LARGEST:
        raise NoPictures(f"{file} has {size} bytes, more than {LARGEST}")
    print(f"{file.relative_to(PROJECT)} {size / 1000:.0f} KB")


def take_all(browser: Browser, url: str, past: str) -> None:
    """All pages that the console links to in English, some in Japanese; then wait until the run is over."""
    PICTURES.mkdir(exist_ok=True)
    pages = {ending: browser.new_page(viewport=SIZE, locale=locale) for ending, locale in LOCALES.items()}
    english = pages[""]
    for page in pages.values():
        page.set_default_timeout(LIMIT * 1000)
        page.goto(url)
        page.wait_for_selector("#pages a")
    for name in english.locator("#pages a").evaluate_all("links => links.map((link) => link.hash.slice(1))"):
        for ending, page in pages.items():
            if page is english or name in JAPANESE:
                open_page(page, url, f"history/{past}" if name == "history" else name)
                keep(page.screenshot(), PICTURES / f"{name}{ending}.png")
    wait_for_end(english, url)


def wait_for_end(page: Page, url: str) -> None:
    """Until the machine stands again."""
    page.goto(f"{url}/#board")
    page.wait_for_selector("#list_machines .card", state="attached")  # the state has come
    page.wait_for_selector("#list_active li", state="detached", timeout=RUN_LIMIT * 1000)


def main() -> int:
    """Exit code 1 and one line when there is nothing to picture."""
    try:
        url = address.url(load_site().file)
        done = finished_run(url)
        with chromium() as browser:
            start(url, done["task_id"])
            take_all(browser, url, done["run_id"])
    except (NoPictures, TmsError) as error:
        print(error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
