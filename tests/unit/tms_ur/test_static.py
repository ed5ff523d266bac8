"""The pages: both languages complete, every text used is there, nothing comes from elsewhere."""

import json
import re
from pathlib import Path

import pytest

import console_types
from conftest import PROJECT
from tms_reason import wire
from tms_reason.reason import REGISTRY, Reason
from tms_reason.texts import translated
from tms_ts.run_states import STATES
from tms_ur.api import BUILT, STATIC
from unit.tms_ur.fakes import Client, FakeSiteClient, app

FILES = sorted(path for path in STATIC.rglob("*") if path.is_file())
CODE = {path: path.read_text(encoding="utf-8") for path in FILES if path.suffix == ".js"}
SOURCE = PROJECT / "services" / "tms_ur" / "console" / "src"
REACT = {path: path.read_text(encoding="utf-8") for path in SOURCE.rglob("*.ts*") if path.name != "api.ts"}
REACT_PAGES = {"board", *(path.parent.name for path in SOURCE.glob("*/*_page.tsx"))}
PAGES = {path: path.read_text(encoding="utf-8") for path in FILES if path.suffix == ".html"}


def table() -> dict[str, dict[str, str]]:
    text = (STATIC / "words.js").read_text(encoding="utf-8")
    found = re.search(r"export const WORDS = (\{.*?\n\});", text, re.DOTALL)
    assert found, "words.js holds no table"
    texts: dict[str, dict[str, str]] = json.loads(found[1])
    return texts


def test_both_languages_have_the_same_texts() -> None:
    texts = table()
    assert set(texts) == {"ja", "en"}
    assert texts["ja"].keys() == texts["en"].keys()
    for key, ja in texts["ja"].items():
        en = texts["en"][key]
        assert ja and en, f"{key} is empty"
        assert sorted(re.findall(r"\{\w+\}", ja)) == sorted(re.findall(r"\{\w+\}", en)), key
        assert not re.search(r"\btms [a-z]|`", f"{ja} {en}"), f"{key} needs a terminal"


def used() -> set[str]:
    found: set[str] = set()
    for text in PAGES.values():
        found |= set(re.findall(r'data-(?:t|label)="(\w+)"', text))
    for text in REACT.values():
        found |= {key for args in re.findall(r"\bt\(([^()]*)", text) for key in re.findall(r'"(\w+)"', args)}
        for label, heads in re.findall(r'\blabel=("\w+")\s+heads=\{\[([^\]]*)\]', text):
            found |= set(re.findall(r'"(\w+)"', label + heads))
    for text in CODE.values():
        found |= set(re.findall(r'\bt\("(\w+)"', text)) | set(re.findall(r'\b(?:t|label): "(\w+)"', text))
        found |= set(re.findall(r'\bbutton\("(\w+)"', text))
    return found


def test_every_text_that_the_pages_ask_for_is_there() -> None:
    assert len(used()) > 60
    assert used() <= table()["en"].keys()


# What people do with their hands: at a machine, at a PC and its files, with a clock, or once more with the same button.
BY_HAND = {"look", "release_stop", "take", "set_clock", "retry", "retype"}
AT_THE_PC = {
    "edit_config", "check", "say_pc", "setup", "up", "users", "file", "restore", "terrain", "ground",
}  # fmt: skip
COMMAND_LINE = {"tms_cli", "tms_ground"}  # packages whose reasons only those hear who have typed a command


def actions(name: str) -> set[str]:
    text = CODE[STATIC / "actions.js"]
    found = re.search(rf"export const {name} = \{{(.*?)\n\}};", text, re.DOTALL)
    assert found
    return set(re.findall(r"\b(\w+): ", found[1]))


def helped() -> list[type[Reason]]:
    """Reasons that a person at the console can meet, with what helps."""
    wire.load()
    ours = [one for one in REGISTRY.values() if one.__module__.startswith("tms_") and one.remedy is not None]
    return [one for one in ours if one.__module__.partition(".")[0] not in COMMAND_LINE]


def test_every_action_of_a_reason_is_a_button_a_link_or_work_by_hand() -> None:
    names = {one.remedy.name for one in helped() if one.remedy}
    known = actions("COMMANDS") | actions("LINKS")
    assert names - known - BY_HAND - AT_THE_PC == set()
    assert known <= names, "the console knows an action that no reason has"
    assert BY_HAND | AT_THE_PC <= names and not known & (BY_HAND | AT_THE_PC)


def test_a_reason_has_what_its_button_needs() -> None:
    needs = {"restart": "process", "cancel": "run", "resume": "run"}
    for kind in helped():
        name = kind.remedy.name if kind.remedy else ""
        if name in actions("COMMANDS") | {"resume"}:
            assert needs.get(name, "machine") in kind.parameters, kind.code


def test_pages_show_no_command_of_a_terminal() -> None:
    for file, text in {**CODE, **REACT}.items():
        assert "action.command" not in text, file


def test_a_run_has_the_states_and_words_of_the_command_line() -> None:
    wanted = {state: translated(state, "ja") for state in STATES}
    words = table()["ja"]
    assert {state: words.get(state) for state in wanted} == wanted


def test_every_title_has_a_page() -> None:
    assert {key.removeprefix("p_") for key in table()["en"] if key.startswith("p_")} <= REACT_PAGES


def test_every_element_that_the_code_asks_for_is_made_somewhere() -> None:
    everything = "".join([*PAGES.values(), *CODE.values(), *REACT.values()])
    made = set(re.findall(r'\bid(?:="|: "| = ")(\w+)"', everything))
    asked = set(re.findall(r'\bat\("(\w+)"\)', "".join(CODE.values())))
    assert asked <= made


@pytest.mark.parametrize("file", [*CODE], ids=lambda path: path.name)
def test_modules_import_what_is_there(file: Path) -> None:
    for names, source in re.findall(r"^import (?:\{([^}]*)\}|\* as \w+) from \"([^\"]+)\";", CODE[file], re.MULTILINE):
        target = CODE[(file.parent / source).resolve()]
        for name in filter(None, (one.strip() for one in names.split(","))):
            assert re.search(rf"^export (?:async )?(?:const|function|class) {name}\b", target, re.MULTILINE), name
            assert len(re.findall(rf"\b{name}\b", CODE[file])) > 1, f"{name} is imported and not used"


@pytest.mark.parametrize("file", FILES, ids=lambda path: path.name)
def test_nothing_comes_from_elsewhere(file: Path) -> None:
    text = file.read_text(encoding="utf-8").replace("http://www.w3.org/2000/svg", "")
    assert not re.search(r"https?://|innerHTML|\bstyle=|<script(?![^>]*src)|\son\w+=", text)


def test_files_are_served() -> None:
    client = Client(app(FakeSiteClient()))
    assert client.get("/").text == (BUILT / "index.html").read_text(encoding="utf-8")
    assert client.get("/dom.js").headers["content-type"].startswith("text/javascript")
    assert client.get("/panel.js").status_code == client.get("/panel.html").status_code == 200
    assert client.get("/../api.py").status_code == client.get("/%2e%2e/api.py").status_code == 404


def test_the_built_page_runs_no_inline_script_and_asks_nobody_else() -> None:
    for file in (path for path in BUILT.rglob("*") if path.suffix in (".html", ".css")):
        text = file.read_text(encoding="utf-8")
        assert not re.search(r"https?://|\bstyle=|<style|<script(?![^>]*src)|\son\w+=|data:", text), file


@pytest.mark.parametrize("path", ["/", "/panel.html", "/dom.js", "/api/session", "/nowhere"])
def test_browsers_run_only_scripts_of_the_site(path: str) -> None:
    """Neither those that are written into a page, nor those that are made from text, nor those of another place."""
    policy = Client(app(FakeSiteClient())).get(path).headers["content-security-policy"]
    rules = dict(rule.strip().split(" ", 1) for rule in policy.split(";"))
    assert rules.get("script-src", rules["default-src"]) == "'self'"
    assert rules.get("connect-src", rules["default-src"]) == "'self'"
    assert rules["base-uri"] == rules["object-src"] == rules["form-action"] == "'none'"


def test_the_lock_file_of_the_console_names_no_registry() -> None:
    """It is made behind other registries than the site's, whose npm has its own. Each package has its digest."""
    lock = json.loads((SOURCE.parent / "package-lock.json").read_text(encoding="utf-8"))
    packages = {name: facts for name, facts in lock["packages"].items() if name}
    assert len(packages) > 50
    assert [name for name, facts in packages.items() if "resolved" in facts or "integrity" not in facts] == []


def test_files_are_sent_compressed() -> None:
    client = Client(app(FakeSiteClient()))
    file = max(BUILT.glob("assets/index-*.js"), key=lambda path: path.stat().st_size)
    answer = client.get(f"/assets/{file.name}", headers={"Accept-Encoding": "gzip"})
    assert answer.headers["content-encoding"] == "gzip" and answer.content == file.read_bytes()


def test_types_of_the_api_are_up_to_date() -> None:
    """`make console-types` writes them anew."""
    assert console_types.FILE.read_text(encoding="utf-8") == console_types.types()
