"""`make pictures`: every page of the console of the running demo.

deploy/pictures/<page>.png are those of README.md and README.ja.md. .state/pictures has all pages in both languages and
three sizes, each page as long as it is: to look at, after a change of the console.

The task of the newest run that succeeded is run once more, or more often, so that there is something to see on the
pages of what goes on now. It is left to end by itself.
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
ALL = PROJECT / ".state" / "pictures"
SIZE = ViewportSize(width=1280, height=800)  # px
SIZES = {  # px
    "phone": ViewportSize(width=390, height=844), "desk": SIZE, "wall": ViewportSize(width=1920, height=1080),
}  # fmt: skip
MORE = ("map/3d", "editor/{task}", "components")  # places that the navigation has no link to
# Pages without navigation: the address, and what shows that it is there.
ALONE = {"panel": ("panel.html?task={task}", "#state:not(:empty)"), "login": ("#login", "#login_name")}
GOING_ON = ("board", "tree")  # places that show the run of now
NOBODY = {"name": None, "role": None, "login": True}  # a session before the login: the demo's console asks for none
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
    "map/3d": ("#space[data-pictures]",),
    "history": ("#list_history tr", "#past [data-path]"),
    "data": ("#list_records tr", "#list_sensing tr"),
    "system": ("#list_processes tr",),
    "tasks": ("#list_stored tr",),
    "editor": ("#page [data-path]",),
    "work": ("#list_work tr, #none_work",),
    "components": ("#page [data-path]",),
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
    """Run a task, if none runs: on a busy PC a run is over before all pictures of it are taken."""
    if ask(url, "/api/state")["runs"]:
        return
    try:
        ask(url, "/api/runs", {"task_id": task})
    except Refused as error:
        raise NoPictures(f"task {task} does not run: {error}") from error


def open_page(page: Page, url: str, place: str) -> None:
    """Show a page (`history`, or `history/RUN`) with what it is about."""
    name = place.partition("/")[0]
    page.goto(f"{url}/#{place}")
    page.wait_for_selector("#connecting", state="hidden")
    for selector in (f"#page[data-page={name}]", *SHOWN.get(place, SHOWN.get(name, ("#page h2",)))):
        try:
            page.wait_for_selector(selector, state="attached")
        except TimeoutError as error:
            raise NoPictures(f"the page {place} shows no {selector} within {LIMIT:.0f} s") from error


def keep(png: bytes, file: Path) -> None:
    """Keep a picture with the 256 colours that suit it best."""
    with Image.open(BytesIO(png)) as picture:
        picture.convert("RGB").quantize().save(file, optimize=True)
    size = file.stat().st_size
    if size > LARGEST and file.is_relative_to(PICTURES):
        raise NoPictures(f"{file} has {size} bytes, more than {LARGEST}")
    print(f"{file.relative_to(PROJECT)} {size / 1000:.0f} KB")


def take_all(browser: Browser, url: str, past: str, task: int) -> None:
    """All places in each language and size; then wait until the run is over."""
    pages = {(ending, size): browser.new_page(viewport=SIZES[size], locale=locale)
             for ending, locale in LOCALES.items() for size in SIZES}  # fmt: skip
    for page in pages.values():
        page.set_default_timeout(LIMIT * 1000)
        page.goto(url)
        page.wait_for_selector("#pages a", state="attached")
    english = pages["", "desk"]
    links = english.locator("#pages a").evaluate_all("links => links.map((link) => link.hash.slice(1))")
    for place in [*links, *(one.format(task=task) for one in MORE)]:
        for (ending, size), page in pages.items():
            if place in GOING_ON:
                start(url, task)
            take(page, url, f"history/{past}" if place == "history" else place, ending, size)
    for (ending, size), page in pages.items():
        take_alone(page, url, task, f"{size}{ending}")
    wait_for_end(english, url)


def take_alone(page: Page, url: str, task: int, ending: str) -> None:
    """The pages of `ALONE`; the page can show the others again afterwards."""
    for name, (place, shown) in ALONE.items():
        if name == "login":
            page.route("**/api/session", lambda route: route.fulfill(json=NOBODY))
        page.goto("about:blank")  # else another place of the same page would not load anew
        page.goto(f"{url}/{place.format(task=task)}")
        try:
            page.wait_for_selector(shown)
        except TimeoutError as error:
            raise NoPictures(f"{name} shows no {shown} within {LIMIT:.0f} s") from error
        keep(page.screenshot(full_page=True), ALL / f"{name}.{ending}.png")
    page.unroute("**/api/session")
    page.goto("about:blank")


def take(page: Page, url: str, place: str, ending: str, size: str) -> None:
    """One place: as long as it is, and as README shows it."""
    open_page(page, url, place)
    name = place.partition("/")[0] if place.startswith("history") else place.replace("/", "_")
    page.evaluate("scrollTo(0, 0)")  # else the header, which stays in sight, is in the middle of the picture
    keep(page.screenshot(full_page=True), ALL / f"{name}.{size}{ending}.png")
    if size == "desk" and place not in MORE and "_" not in name and (not ending or name in JAPANESE):
        keep(page.screenshot(), PICTURES / f"{name}{ending}.png")


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
            for folder in (PICTURES, ALL):
                folder.mkdir(parents=True, exist_ok=True)
            take_all(browser, url, done["run_id"], done["task_id"])
    except (NoPictures, TmsError) as error:
        print(error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
