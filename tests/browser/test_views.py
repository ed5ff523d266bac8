"""Views of the console that no other test opens: each is there and does what it says."""

import re
import zipfile
from collections.abc import Iterator
from datetime import timedelta
from pathlib import Path

import pytest
import yaml
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Page, expect

from tms_ts.bt import palette
from tms_ur.access import hashed
from tms_ur.data_models import Change
from tms_ur.ground_models import Ground
from tms_ur.models import Event, Place, Task
from unit.tms_ur.fakes import NOON
from yard import RUN, Yard, serving, shape

pytestmark = [pytest.mark.turns, pytest.mark.browser]
LEAF = '<Action ID="LeafNodeZx200" model_name="zx200" subtask_name="dig" record_name="{record}"/>'
TEXTS = {4: LEAF.format(record="OLD"), 5: LEAF.format(record="NEW") + "<AlwaysSuccess/>"}
PLACES = ("board", "tree", "map", "map/3d", "history/r-1", "work", "data", "system", "tasks", "editor/4", "components")
SIDE = 8  # cells of the ground along each axis


class Versions(Yard):
    """Two versions of a task; ground with a design below it; a record whose values changed during the run."""

    def tasks(self) -> list[Task]:
        facts = {"model_name": "zx200", "added_at": NOON}
        return [Task(id=number, description=f"dig | {number}", **facts) for number in TEXTS]

    def task(self, task_id: int) -> object:  # type: ignore[override]
        tree = f'<BehaviorTree ID="M"><Sequence>{TEXTS[task_id]}</Sequence></BehaviorTree>'
        xml = f'<root main_tree_to_execute="M">{tree}</root>'
        return super().task(task_id).model_copy(update={"id": task_id, "xml": xml})

    def ground(self, cells: int) -> Ground:
        heights: list[float | None] = [0.1 * (number % SIDE) for number in range(SIDE * SIDE)]
        return Ground(x0=-10.0, y0=-10.0, cell=2.5, rows=SIDE, columns=SIDE, heights=heights, design=[2.0] * SIDE**2)

    def parameter_history(self, model_name: str, record_name: str, limit: int) -> list[Change]:
        later = NOON + timedelta(seconds=10)
        return [Change(stamp=later, source="sensing", values={"d": 2.0}),
                Change(stamp=NOON, source="cli", values={"d": 1.0})]  # fmt: skip


@pytest.fixture
def yard() -> Versions:
    yard = Versions(ground={"area": [-10.0, -10.0, 10.0, 10.0]})
    yard.receive()
    yard.palette = palette(builtin=True)
    yard.board.put_place("ic120", Place(x=1.0, y=2.0, yaw=0.5))
    stamps = [NOON + timedelta(seconds=seconds) for seconds in (0, 5, 12, 20)]
    tree = {**shape(2, 2)}
    tree["ports"] = [text.replace("zx200", "ic120") if "R0.1" in text else text for text in tree["ports"]]
    yard.journals = {"r-1": [
        Event(number=1, stamp=stamps[0], kind="tree", node="", text="", values={**tree}),
        Event(number=2, stamp=stamps[1], kind="stop", node="", text="zx200 was stopped"),
        Event(number=3, stamp=stamps[2], kind="stop", node="", text="ic120 was stopped"),
        Event(number=4, stamp=stamps[3], kind="run", node="", text="ended"),
    ]}  # fmt: skip
    return yard


@pytest.fixture
def address(yard: Versions, tmp_path: Path) -> Iterator[str]:
    with serving(yard, tmp_path) as address:
        yield address


def test_one_jumps_from_stop_to_stop(page: Page, address: str) -> None:
    page.goto(f"{address}/#history/r-1/0")
    after, before = page.get_by_role("button", name="Next stop"), page.get_by_role("button", name="Stop before")
    slider = page.locator("#slider")
    expect(before).to_be_disabled()
    after.click()
    expect(slider).to_have_value("50")  # tenths of a second
    after.click()
    expect(slider).to_have_value("120")
    expect(after).to_be_disabled()
    before.click()
    expect(slider).to_have_value("50")


def test_the_tree_has_an_overview_and_tells_whose_colours_are_whose(page: Page, address: str) -> None:
    page.goto(f"{address}/#tree")
    expect(page.locator("#tree_box .react-flow__minimap-node")).to_have_count(7)
    expect(page.get_by_role("img", name="Overview")).to_be_visible()
    legend = page.get_by_role("list", name="Machines")
    expect(legend.locator("li")).to_have_text(["zx200", "ic120"])
    for machine, path in (("zx200", "0.0.0"), ("ic120", "0.1.0")):
        swatch = legend.locator("li", has_text=machine).locator(".swatch")
        colour = swatch.evaluate("it => getComputedStyle(it).backgroundColor")
        expect(page.locator(f"[data-path='{path}'] .band")).to_have_css("background-color", colour)


def test_a_leaf_of_the_past_tells_its_record_of_then(page: Page, address: str) -> None:
    page.goto(f"{address}/#history/r-1/5")
    page.locator("#past [data-path='0.0.0']").click()
    then = page.locator("#record_then")
    expect(then).to_contain_text("Record zx200/R0.0.0 at this moment")
    expect(then).to_contain_text("d: 1")
    page.locator("#slider").fill("150")
    expect(then).to_contain_text("d: 2")
    expect(then).to_contain_text("(sensing)")


def test_the_difference_of_two_versions_is_a_picture(page: Page, address: str) -> None:
    """From the text of the difference one goes to the picture of the same versions."""
    page.set_viewport_size({"width": 1280, "height": 500})
    page.goto(f"{address}/#tasks")
    page.get_by_role("button", name=re.compile("older")).click()
    page.get_by_role("button", name=re.compile("5.*4")).click()
    expect(page.locator("#version_difference .added").first).to_be_in_viewport()
    page.get_by_role("link", name="Picture of the difference").click()
    expect(page).to_have_url(f"{address}/#editor/5/difference/4")
    picture = page.get_by_role("region", name="Difference")
    expect(picture.get_by_label("Compare with task")).to_have_value("4")
    expect(picture.get_by_role("status")).to_have_text("New: 1, Gone: 0, Changed: 1")
    expect(picture.locator("[data-path]")).to_have_count(3)
    picture.get_by_role("button", name=re.compile("LeafNodeZx200")).click()
    expect(picture.locator("pre .removed")).to_contain_text('record_name="OLD"')
    expect(picture.locator("pre .added")).to_contain_text('record_name="NEW"')


def test_a_tree_of_the_task_and_a_template_are_in_the_palette(page: Page, address: str) -> None:
    page.goto(f"{address}/#editor/4")
    page.get_by_role("textbox", name="Name of a new tree").fill("Part")
    page.get_by_role("button", name="Add a tree").click()
    page.get_by_role("button", name="M", exact=True).click()
    entries = page.get_by_role("region", name="Nodes to add")
    page.locator("[data-path='0']").click()
    for group, name in (("Trees of this task", "Part"), ("Templates", "Dig")):
        entries.get_by_text(group, exact=True).click()
        entries.get_by_role("button", name=name, exact=True).click()
        page.locator("[data-path='0']").click()
    nodes = page.locator("[data-path]")
    expect(nodes.nth(2)).to_contain_text("Part")
    expect(nodes.nth(3)).to_contain_text("ExecuteSubtask")
    expect(page.get_by_role("link", name="template Dig")).to_be_visible()


def test_the_design_is_shown_in_3d_on_demand(page: Page, address: str) -> None:
    page.goto(f"{address}/#map/3d")
    space, design = page.locator("#space"), page.get_by_role("checkbox", name="Design surface")
    expect(space).to_have_attribute("data-triangles", re.compile(r"[1-9]"))
    looks: list[bytes] = []
    for shown in (False, True, False):
        before = space.get_attribute("data-pictures") or ""
        if shown != design.is_checked():
            design.set_checked(shown)
            expect(space).not_to_have_attribute("data-pictures", before)  # it was drawn anew
        looks.append(space.screenshot())
    assert looks[0] != looks[1]
    assert looks[0] == looks[2]


def test_the_map_offers_models_of_its_machines(page: Page, address: str) -> None:
    page.goto(f"{address}/#map")
    with page.expect_download() as download:
        page.get_by_role("link", name=re.compile("URDF.*zx200")).click()
    with zipfile.ZipFile(download.value.path()) as found:
        assert [name for name in found.namelist() if name.endswith(".urdf")]
        assert found.testzip() is None


def test_3d_the_panel_and_the_login_are_accessible(page: Page, address: str, yard: Versions, tmp_path: Path) -> None:
    """Of a phone, then of a large screen in the dark."""
    users = tmp_path / "users.yaml"
    users.write_text(yaml.safe_dump({"users": {"ken": {"role": "operator", "password": hashed("ken-pass")}}}))
    users.chmod(0o600)
    closed = Yard()
    folder = tmp_path / "closed"
    folder.mkdir()
    with serving(closed, folder, users) as other:
        for url, shown in (
            (f"{address}/#map/3d", "#space[data-pictures]"),
            (f"{address}/panel.html?task=4", "#state:not(:empty)"),
            (f"{other}/", "#login_name"),
        ):
            page.emulate_media(color_scheme="light")
            page.set_viewport_size({"width": 390, "height": 844})
            page.goto(url)
            expect(page.locator(shown)).to_be_visible()
            assert page.evaluate("document.documentElement.scrollWidth") <= 390, url
            for scheme, size in (("light", (390, 844)), ("dark", (1920, 1080))):
                page.emulate_media(color_scheme=scheme)  # type: ignore[arg-type]
                page.set_viewport_size({"width": size[0], "height": size[1]})
                found = Axe().run(page)
                assert found.violations_count == 0, f"{url} {scheme}\n{found.generate_report()}"


def test_no_request_leaves_the_site(page: Page, address: str, yard: Versions) -> None:
    """None is even tried: the policy of the site would refuse it, and the browser would say so."""
    asked: set[str] = set()
    refused: list[str] = []
    page.on("console", lambda said: refused.append(said.text) if "Content Security Policy" in said.text else None)
    page.on("request", lambda request: asked.add(request.url))
    page.on("websocket", lambda socket: asked.add(socket.url))
    yard.board.put_runs([RUN])
    for place in PLACES:
        page.goto("about:blank")  # so that each page loads all that it needs
        page.goto(f"{address}/#{place}")
        expect(page.locator("#page")).to_have_attribute("data-page", place.partition("/")[0])
        expect(page.locator("#connecting")).to_be_hidden()
        expect(page.locator("#page > *").first).to_be_attached()  # the part of the console that is the page has come
    page.goto(f"{address}/panel.html?task=4")
    expect(page.locator("#state")).not_to_be_empty()
    own = re.compile(rf"^(?:{re.escape(address)}/|ws{re.escape(address[4:])}/|blob:{re.escape(address)}/|about:|data:)")
    assert len(asked) > len(PLACES)
    assert [url for url in asked if not own.match(url)] == []
    assert refused == []


def test_a_page_that_does_not_load_leaves_the_stop_in_reach(page: Page, address: str) -> None:
    """As where the server goes while one changes the page, or has another release since."""
    files = "**/assets/*_page-*.js"
    page.goto(f"{address}/#board")
    expect(page.locator("#light")).to_be_visible()
    page.route(files, lambda route: route.abort())
    page.get_by_role("link", name="Map", exact=True).click()
    expect(page.get_by_role("alert").get_by_text("This page cannot be shown")).to_be_visible()
    expect(page.get_by_role("button", name="Software stop", exact=True)).to_be_in_viewport(ratio=1)
    assert Axe().run(page).response["violations"] == []
    page.get_by_role("link", name="Board", exact=True).click()
    expect(page.locator("#light")).to_be_visible()
    page.get_by_role("link", name="Map", exact=True).click()
    page.unroute(files)
    page.get_by_role("button", name="Load it again").click()
    expect(page.locator("#map_box [data-machine=ic120]")).to_be_visible()
