"""What an operator does with the console, in a real browser against a running mesh."""

import json
import re
import urllib.request
from pathlib import Path

import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Browser, Page, Request, Route, expect

from browsers import LIMIT, ask
from conftest import Mesh, wait_until
from tms_ur.api import STATIC

pytestmark = [pytest.mark.system, pytest.mark.browser]
PAGES = sorted(set(re.findall(r'"p_(\w+)"', (STATIC / "words.js").read_text(encoding="utf-8"))))
REMOVE = re.compile(r"^Remove task \d+$")
SWINGS = 3  # number of the task of long swings to and fro
FIRST_PAGE = 150_000  # bytes, compressed
TARGET = 44  # px
BROKEN = """<root main_tree_to_execute="MainTree">
  <BehaviorTree ID="MainTree">
    <Sequence>
      <LeafNodeZx200 model_name="zx200" subtask_name="subtask_zx200_release_simple" record_name="release_angle"/>
      <DigDeeper/>
    </Sequence>
  </BehaviorTree>
</root>
"""
ASKING = """<root main_tree_to_execute="MainTree"><BehaviorTree ID="MainTree">
  <Timeout msec="600000"><WaitForClick window_title="Safety" button_info="Is the yard clear?"/></Timeout>
</BehaviorTree></root>
"""


MOVED = """([box, told]) => {
    const button = document.querySelector(`${box} .stop`);
    const at = () => { const found = button.getBoundingClientRect(); return [found.x, found.y]; };
    const [x, y] = at(), long = document.createElement("span");
    long.textContent = "It waits for something that is said in many words. ".repeat(9);
    document.querySelector(`${box} ${told}`).prepend(long);
    const [now_x, now_y] = at();
    long.remove();
    return Math.hypot(now_x - x, now_y - y);
}"""  # px that a red button is moved by words that come
LOOK = """hidden => {
    Object.defineProperty(document, "hidden", { configurable: true, get: () => hidden });
    document.dispatchEvent(new Event("visibilitychange"));
}"""  # what a browser with a screen does when its tab is changed; a headless one shows all of its pages


def open_page(page: Page, address: str, name: str) -> None:
    page.goto(f"{address}/#{name}")
    expect(page.locator("#page")).to_have_attribute("data-page", name)
    expect(page.locator("#connecting")).to_be_hidden()


def start(page: Page, task: int) -> None:
    page.get_by_role("button", name=f"Run task {task}", exact=True).click()
    expect(page.locator("#dialog_text")).to_contain_text(f"Start task {task}")
    page.locator("#dialog_yes").click()


def stop(page: Page) -> None:
    page.get_by_role("button", name="Software stop", exact=True).click()
    expect(page.locator("#stop_report")).to_contain_text("seen to stand after")


def rearm(page: Page) -> None:
    page.get_by_role("button", name="Re-arm zx200").click()
    expect(page.locator("#dialog_text")).to_contain_text("zx200 was stopped: software stop by local")
    page.locator("#dialog_yes").click()
    expect(page.locator("#message")).to_have_text("zx200 is armed.")


def upload(page: Page, text: str) -> None:
    page.locator("#file").set_input_files({"name": "task.xml", "mimeType": "text/xml", "buffer": text.encode()})


def store(page: Page) -> int:
    page.locator("#store").click()
    message = page.locator("#message")
    expect(message).to_have_text(re.compile(r"task \d+"))
    found = re.search(r"task (\d+)", message.inner_text())
    assert found
    return int(found[1])


def test_upload_fix_run_watch_stop_rearm_and_run_again(page: Page, address: str, idle: Mesh, tmp_path: Path) -> None:
    """From the console alone, as somebody does who has never seen it."""
    open_page(page, address, "tasks")
    fixed = BROKEN.replace("<DigDeeper/>", "<AlwaysSuccess/>")
    upload(page, BROKEN)
    expect(page.locator("#findings li")).to_contain_text(["DigDeeper"])
    expect(page.locator("#source li.errors")).to_contain_text("<DigDeeper/>")  # the line itself is marked
    wrong_record = BROKEN.replace("<DigDeeper/>", "<AlwaysSuccess/>").replace("release_angle", "release_angel")
    file = tmp_path / "mine.xml"
    for text, said in ((wrong_record, "did you mean 'release_angle'"), (fixed, "nothing to complain of")):
        file.write_text(text)  # corrected where it is, and chosen again
        with page.expect_file_chooser() as chooser:
            page.locator("#file").click()
        chooser.value.set_files(file)
        expect(page.locator("#findings")).to_contain_text(said)
    expect(page.locator("#findings")).to_contain_text("nothing to complain of")
    page.locator("#compare").select_option("1")
    expect(page.locator("#difference .added").nth(1)).to_be_visible()
    task = store(page)

    run_to_its_end(page, address, idle, task)
    watch_and_stop(page)
    arm_and_run_again(page, address)


def run_to_its_end(page: Page, address: str, idle: Mesh, task: int) -> None:
    open_page(page, address, "board")
    start(page, task)
    expect(page.locator("#message")).to_contain_text(re.compile("has begun|Success"))
    newest = lambda: json.loads(idle.tms("runs", "--limit", "1", "--json").stdout)[0]  # noqa: E731
    wait_until(lambda: newest()["task_id"] == task and newest()["ended_at"], 60, "its end")
    expect(page.locator("#list_active li")).to_have_count(0)


def watch_and_stop(page: Page) -> None:
    start(page, SWINGS)
    page.locator("#list_active a", has_text="Tree").click()
    running = page.locator("#tree_box [data-state=running]")
    expect(running.first).to_be_visible()
    expect(page.locator("#tree_box .current")).to_have_count(1)
    states = "() => [...document.querySelectorAll('#tree_box [data-path]')].map(n => n.dataset.state).join()"
    before = page.evaluate(states)
    page.wait_for_function(f"before => ({states})() !== before", arg=before)  # nodes change their colour
    expect(page.locator("#tree_why")).to_contain_text(re.compile("What it does|Why is it not moving"))
    stop(page)
    assert re.search(r"after \d+(\.\d+)? s", page.locator("#stop_report").inner_text())


def arm_and_run_again(page: Page, address: str) -> None:
    open_page(page, address, "board")
    expect(page.locator("[data-machine=zx200]")).to_contain_text("Stopped because: software stop by local")
    expect(page.locator("#list_active li")).to_have_count(0)
    start(page, 1)
    expect(page.locator("#message.bad")).to_contain_text("zx200")  # refused while it is stopped
    rearm(page)
    start(page, SWINGS)
    expect(page.locator("#list_active li")).to_have_count(1)
    for box, told in (("#list_active li", "[data-part=reason]"), ("[data-machine=zx200]", ".badge")):
        assert page.evaluate(MOVED, [box, told]) == 0  # a click has two ends, and words come between them, too
    page.get_by_role("button", name="Cancel run").click()
    expect(page.locator("#list_active li")).to_have_count(0)


def test_the_stop_is_in_reach_everywhere(page: Page, address: str, idle: Mesh) -> None:
    """On a small screen, wherever one has scrolled to, and above a question that waits for an answer."""
    page.set_viewport_size({"width": 640, "height": 400})
    for name in PAGES:
        open_page(page, address, name)
        page.evaluate("scrollTo(0, document.body.scrollHeight)")  # at once: a wheel scrolls some time later
        expect(page.locator("#stop")).to_be_in_viewport(ratio=1)
    page.set_viewport_size({"width": 390, "height": 844})
    page.evaluate("scrollTo(0, 0)")
    for name in PAGES:
        expect(page.locator(f"#pages a[href='#{name}']")).to_be_in_viewport(ratio=1)

    open_page(page, address, "tasks")
    idle.tms("run", str(SWINGS))
    expect(page.get_by_role("button", name=REMOVE).first).to_be_visible()
    stored = page.locator("#list_stored tr").count()
    page.get_by_role("button", name=REMOVE).first.click()
    page.locator("#dialog_stop").click()
    expect(page.locator("#stop_report")).to_contain_text("zx200: seen to stand after")
    expect(page.locator("#list_stored tr")).to_have_count(stored)  # and nothing was removed


@pytest.mark.turns
def test_a_list_that_comes_late_does_not_get_into_the_next_page(page: Page, address: str, idle: Mesh) -> None:
    open_page(page, address, "system")
    held: list[Route] = []
    page.route("**/api/tasks", lambda route: held.append(route))
    for number, name in enumerate(("board", "tasks")):  # both show the tasks, with other buttons
        page.evaluate("name => { location.hash = name; }", name)
        wait_until(lambda: bool(page.evaluate("1")) and len(held) > number, 60, f"{name} asks")  # noqa: B023
    with page.expect_response("**/api/tasks"):
        held[0].continue_()
    for route in held[1:]:
        route.continue_()
    expect(page.get_by_role("button", name=REMOVE).first).to_be_visible()
    expect(page.get_by_role("button", name="Run task 1", exact=True)).to_have_count(0)


def test_one_machine_is_stopped(page: Page, address: str, idle: Mesh) -> None:
    open_page(page, address, "board")
    button = page.get_by_role("button", name="Software stop of zx200", exact=True)
    expect(button).to_be_visible()  # a full PC takes its time for the page
    idle.tms("run", str(SWINGS))
    wait_until(lambda: [run["state"] for run in ask(address, "/api/state")["runs"]] == ["running"], LIMIT, "it runs")
    button.click()
    expect(page.locator("#stop_report")).to_contain_text("zx200: seen to stand after")
    expect(page.locator("#message")).to_contain_text("Cancelled after")  # how the run has ended
    page.locator("#message a").click()
    expect(page.locator("#receipts li").first).to_contain_text(re.compile(r"^\d\d:\d\d:\d\d\.\d zx200 stood"))
    page.locator("#language").click()
    open_page(page, address, "board")
    expect(page.locator("[data-machine=zx200]")).to_contain_text(re.compile("停止の理由: .*local"))
    page.go_back()
    page.reload()  # the run has an address of its own
    by_local = re.compile(r"zx200 \d.*で静止.*local.*によるソフト停止")  # beside that of a goal that came after it
    expect(page.locator("#receipts li").filter(has_text=by_local)).to_have_count(1)


@pytest.mark.turns
def test_history_replays_a_stopped_run(page: Page, address: str, idle: Mesh) -> None:
    idle.tms("run", str(SWINGS))
    idle.tms("stop")
    open_page(page, address, "history")
    page.get_by_role("button", name="Show run").first.click()
    expect(page.locator("#receipts li").first).to_contain_text("zx200")
    nodes = page.locator("#past [data-path]")
    expect(nodes.first).to_be_visible()
    page.locator("#slider").fill("0")
    assert {node.get_attribute("data-state") for node in nodes.all()} == {"idle"}
    last = int(page.locator("#slider").get_attribute("max") or 0)
    seen = set()
    for moment in range(last + 1):
        page.locator("#slider").fill(str(moment))
        seen |= {node.get_attribute("data-state") for node in nodes.all()}
        if "running" in seen:
            break
    assert "running" in seen
    for form in ("json", "csv", "mcap"):
        link = page.locator("#exports a", has_text=form.upper()).get_attribute("href")
        with urllib.request.urlopen(address + str(link), timeout=30) as answer:
            assert len(answer.read()) > 200, form
    run = page.url.partition("#history/")[2].partition("/")[0]
    told = f"/api/recordings?run_id={run}&machine=zx200"
    wait_until(lambda: ask(address, told)["series"], LIMIT, "the recorder has stored what the run was")
    page.reload()
    expect(page.locator("#list_motion [data-machine=zx200]")).to_contain_text("swing_joint")
    expect(page.locator("#motion .plot canvas").first).to_be_visible()


@pytest.mark.turns
def test_a_question_is_answered(page: Page, address: str, idle: Mesh, tmp_path: Path) -> None:
    file = tmp_path / "asking.xml"
    file.write_text(ASKING)
    task = json.loads(idle.tms("task", "add", str(file), "--json").stdout)["task_id"]
    open_page(page, address, "board")
    start(page, task)
    question = page.locator("#questions .question")
    expect(question).to_contain_text("Is the yard clear?")
    expect(question).to_contain_text("s left")
    expect(page.locator("#list_active")).to_contain_text("waits for an operator")
    assert json.loads(idle.tms("answer", "--json").stdout)[0]["text"] == "Is the yard clear?"
    question.get_by_role("button", name="Yes").click()
    expect(question).to_have_count(0)
    events = json.loads(idle.tms("events", "last", "--json").stdout)
    rows = events["events"] if isinstance(events, dict) else events
    answers = [row["text"] for row in rows if row["kind"] == "answer"]
    assert answers == ["yes, by local at 127.0.0.1"]

    idle.tms("run", str(task))  # and now from the command line
    expect(question).to_contain_text("Is the yard clear?")
    assert "answered no" in idle.tms("answer", "no").stdout
    expect(question).to_have_count(0)


@pytest.mark.turns
def test_two_consoles_agree_and_one_run_starts(page: Page, chromium: Browser, address: str, idle: Mesh) -> None:
    other = chromium.new_page(locale="en-GB")
    try:
        open_page(page, address, "board")
        open_page(other, address, "board")
        tasks = "() => document.getElementById('list_tasks').getBoundingClientRect().y"
        place = page.evaluate(tasks)
        page.get_by_role("button", name=f"Run task {SWINGS}", exact=True).dblclick()
        expect(page.locator("#will_move li")).to_have_text(["zx200"])
        page.locator("#dialog_yes").click()
        expect(page.locator("#message")).to_contain_text("has begun")
        expect(page.locator("#list_active li")).to_have_count(1)
        expect(other.locator("#list_active li")).to_have_count(1)
        assert page.evaluate(tasks) == place  # nothing has moved under the finger
        start(other, 1)
        expect(other.locator("#message")).to_contain_text("zx200 is in run")
        for each in (page, other):  # the refused one is shown for a moment
            expect(each.locator("#list_active li")).to_have_count(1)
        assert page.locator("#list_active strong").inner_text() == other.locator("#list_active strong").inner_text()
    finally:
        other.close()


def test_the_panel_starts_and_stops(page: Page, address: str, idle: Mesh) -> None:
    page.goto(idle.tms("panel", "--task", str(SWINGS), "--url").stdout.strip())
    expect(page.locator("#state")).to_have_text("Ready to start.")
    page.locator("#start").click()
    page.locator("#dialog_yes").click()
    expect(page.locator("#state")).to_contain_text("Running")
    expect(page.locator("#start")).to_be_disabled()
    page.locator("#stop").click()
    expect(page.locator("#stop_report")).to_contain_text("zx200: seen to stand")
    expect(page.locator("#machines")).to_contain_text("Stopped because")
    for name in ("start", "stop"):
        box = page.locator(f"#{name}").bounding_box()
        assert box is not None
        assert box["height"] >= 150, f"{name} is small for a glove"


def test_a_lost_server_is_shown_and_heals(page: Page, address: str, idle: Mesh) -> None:
    open_page(page, address, "board")
    lost = page.locator("#lost")
    expect(lost).to_be_hidden()
    idle.tms("stop-process", "tms:ur")
    expect(lost).to_be_visible()
    machine = page.locator("[data-machine=zx200]")
    expect(machine).to_contain_text("No word")
    age = machine.locator("[data-part=age]")
    before = age.inner_text()
    expect(age).not_to_have_text(before)  # it grows
    page.locator("#stop").click()
    expect(page.locator("#stop_report")).to_contain_text("NOT STOPPED")
    expect(page.locator("#stop_report")).to_contain_text("emergency stop")
    idle.tms("start", "tms:ur")
    expect(lost).to_be_hidden()
    expect(page.locator("#stop_report")).to_contain_text("zx200: seen to stand")  # it was asked for again
    rearm(page)
    expect(page.locator("#list_tasks li").first).to_be_visible()


@pytest.mark.turns
def test_the_stop_of_a_seventh_page_is_not_kept_waiting(page: Page, address: str, idle: Mesh) -> None:
    """A browser has six connections to a server over all its pages: those that nobody looks at must hold none."""
    others = [page.context.new_page() for _ in range(6)]
    for other in others:
        open_page(other, address, "board")
        other.evaluate(LOOK, True)
    idle.tms("run", str(SWINGS))
    open_page(page, address, "board")
    stop(page)
    card = others[0].locator("[data-machine=zx200]")
    expect(card).not_to_contain_text("Stopped because")  # it does not listen
    others[0].evaluate(LOOK, False)
    expect(card).to_contain_text("Stopped because")


@pytest.mark.turns
def test_a_page_that_is_looked_at_again_shows_nothing_old_as_new(page: Page, address: str, idle: Mesh) -> None:
    open_page(page, address, "board")
    card, lost = page.locator("[data-machine=zx200]"), page.locator("#lost")
    expect(card).not_to_contain_text("No word")
    page.evaluate(LOOK, True)
    page.wait_for_timeout(2500)  # ms: longer than the silence after which a page that is looked at is told
    expect(lost).to_be_hidden()
    page.route("**/api/events", lambda route: None)  # the server takes its time
    page.evaluate(LOOK, False)
    expect(page.locator("#connecting")).to_be_visible()
    expect(card).to_contain_text("No word")
    expect(lost).to_be_visible()
    page.unroute("**/api/events")
    expect(lost).to_be_hidden()
    expect(card).not_to_contain_text("No word")


def english(page: Page) -> list[str]:
    """English words on a page in Japanese."""
    left = page.evaluate("() => [...document.querySelectorAll('button,h2,th')].map(e => e.textContent.trim())")
    return [text for text in left if re.fullmatch(r"[A-Za-z ]{4,}", text) and text not in ("English", "JSON")]


@pytest.mark.turns
def test_both_languages_and_the_choice_is_remembered(page: Page, address: str, mesh: Mesh) -> None:
    open_page(page, address, "board")
    for name in PAGES:
        open_page(page, address, name)
        page.locator("#language").click()
        assert page.evaluate("document.documentElement.lang") == "ja"
        empty = "() => [...document.querySelectorAll('[data-t]')].filter(e => !e.textContent).map(e => e.dataset.t)"
        assert page.evaluate(empty) == []
        wait_until(lambda: not english(page), 20, lambda: f"{name}: not translated: {english(page)}")  # noqa: B023
        page.locator("#language").click()
    page.locator("#language").click()
    page.reload()
    expect(page.locator("#stop")).to_have_text("ソフト停止")


@pytest.mark.turns
@pytest.mark.parametrize("name", [*PAGES, "panel"])
def test_accessible_and_large_enough_for_fingers(page: Page, address: str, mesh: Mesh, name: str) -> None:
    if name == "panel":
        page.goto(f"{address}/panel.html?task=1")
        expect(page.locator("#state")).not_to_be_empty()
    else:
        open_page(page, address, name)
        expect(page.locator("#page h2").first).to_be_visible()
    found = Axe().run(page)
    assert found.violations_count == 0, found.generate_report()
    small = page.evaluate(
        """least => [...document.querySelectorAll("button, a, input, select")].filter(e => e.checkVisibility()
            && !e.classList.contains("skip")).filter(e => { const r = e.getBoundingClientRect();
            return r.height < least || r.width < least; }).map(e => e.outerHTML.slice(0, 90))""",
        TARGET,
    )
    assert small == []


@pytest.mark.turns
def test_keyboard_alone(page: Page, address: str, mesh: Mesh) -> None:
    open_page(page, address, "board")
    expect(page.locator("#list_tasks li").first).to_be_visible()
    reached = set()
    for _ in range(40):
        page.keyboard.press("Tab")
        reached.add(page.evaluate("document.activeElement.id || document.activeElement.ariaLabel || ''"))
    assert {"skip", "language", "stop", "Run task 1", "Software stop of zx200"} <= reached
    page.locator("#pages a[href='#data']").focus()
    page.keyboard.press("Enter")
    expect(page.locator("#page")).to_have_attribute("data-page", "data")


@pytest.mark.turns
def test_a_record_is_edited_with_its_type(page: Page, address: str, mesh: Mesh) -> None:
    open_page(page, address, "data")
    before = json.loads(mesh.tms("param", "get", "zx200/release_angle", "--json").stdout)
    page.get_by_role("button", name="Edit zx200/release_angle").click()
    expect(page.locator("#editor label").first).to_contain_text("target_angle [rad] (")
    field = page.locator("#editor input").first
    old = field.input_value()
    field.fill("1.0")
    page.get_by_role("button", name="Save").click()
    expect(page.locator("#message")).to_contain_text("was saved")
    audit = lambda: json.load(urllib.request.urlopen(f"{address}/api/audit", timeout=10))  # noqa: E731
    wait_until(lambda: any(row["node"].startswith("zx200/release_angle") for row in audit()), 60, "audited")
    page.reload()
    expect(page.locator("#list_changes")).to_contain_text("zx200/release_angle")
    assert " 1.0 rad" in mesh.tms("param", "get", "zx200/release_angle").stdout
    page.get_by_role("button", name="Edit zx200/release_angle").click()
    page.locator("#editor input").first.fill("far")
    page.get_by_role("button", name="Save").click()
    problem = page.locator("#editor_problem")
    expect(problem).to_have_text("target_angle: 'far' is no decimal number; write it like -1.05")
    expect(problem).to_be_in_viewport()
    page.locator("#editor input").first.fill(old)
    page.get_by_role("button", name="Save").click()
    expect(page.locator("#editor")).to_be_hidden()
    page.get_by_role("button", name="History of zx200/release_angle").click()
    values = page.locator("#list_values")
    expect(values).to_contain_text("target_angle: 1.0 rad")
    expect(values.locator("tr").first).to_contain_text(old)
    inputs = page.locator("#list_sensing tr", has_text="/tms_sp_change_pose")
    expect(inputs).to_contain_text("Waiting")
    page.locator("#language").click()
    expect(inputs).to_contain_text("受信待ち")
    page.get_by_role("button", name="zx200/release_angle の履歴").click()
    expect(page.locator("#values_title")).to_have_text("zx200/release_angle の値の履歴")
    page.get_by_role("button", name="zx200/release_angle を編集").click()
    found = Axe().run(page)  # with everything open that the page has
    assert found.violations_count == 0, found.generate_report()
    after = json.loads(mesh.tms("param", "get", "zx200/release_angle", "--json").stdout)
    assert after["values"] == before["values"] if "values" in before else True


@pytest.mark.turns
def test_a_record_is_made(page: Page, address: str, mesh: Mesh) -> None:
    open_page(page, address, "data")
    expect(page.get_by_role("button", name="Edit zx200/initial_pose", exact=True)).to_be_visible()
    page.get_by_role("button", name="New record").click()
    page.locator("#new_model").fill("zx200")
    page.locator("#new_name").fill("initial_pose")
    field = page.locator("#new_fields .new_field").first
    field.locator("input").first.fill("height")
    field.locator("input").last.fill("1.5")
    page.get_by_role("button", name="Save").click()
    expect(page.locator("#editor_problem")).to_contain_text("zx200/initial_pose exists already")
    page.locator("#new_name").fill("made_here")
    page.get_by_role("button", name="Save").click()
    expect(page.locator("#message")).to_have_text("zx200/made_here was saved.")
    stored = json.loads(mesh.tms("param", "get", "zx200/made_here", "--json").stdout)
    assert (stored["type"], stored["values"]) == ("static", {"height": 1.5})
    mesh.tms("param", "rm", "zx200/made_here")


@pytest.mark.turns
def test_processes_logs_and_restart(page: Page, address: str, mesh: Mesh) -> None:
    open_page(page, address, "system")
    page.get_by_role("button", name="Log of tms:db", exact=True).click()
    expect(page.locator("#log_text")).to_contain_text("process=tms:db")
    page.get_by_role("button", name="Restart zx200:rp", exact=True).click()
    page.locator("#dialog_yes").click()
    expect(page.locator("#message")).to_have_text("zx200:rp was restarted.")
    expect(page.locator("[data-process='zx200:rp']")).to_contain_text("Running")
    mesh.wait_ready()


@pytest.mark.turns
def test_the_site_shows_place_and_arm(page: Page, address: str, mesh: Mesh) -> None:
    open_page(page, address, "map")
    expect(page.locator("#map_box [data-machine=zx200]")).to_have_count(1)
    arm = page.locator("#arms [data-machine=zx200] polygon.arm")
    expect(arm).to_have_count(2)  # boom and arm
    assert float((arm.first.get_attribute("points") or "").split()[3].split(",")[1]) < -2, "the boom stands up, m"


@pytest.mark.turns
def test_the_editor_offers_the_nodes_of_the_scheduler(page: Page, address: str, mesh: Mesh) -> None:
    page.goto(f"{address}/#editor/new")
    page.get_by_text("zx200", exact=True).click()
    expect(page.get_by_role("button", name="subtask_zx200_change_pose", exact=True)).to_be_visible()


@pytest.mark.turns
def test_the_first_page_is_small(page: Page, address: str, mesh: Mesh) -> None:
    files: list[Request] = []
    page.on("requestfinished", lambda request: None if "/api/" in request.url else files.append(request))
    open_page(page, address, "board")
    expect(page.locator("#list_tasks li").first).to_be_visible()
    assert len(files) > 5
    assert sum(file.sizes()["responseBodySize"] for file in files) <= FIRST_PAGE
