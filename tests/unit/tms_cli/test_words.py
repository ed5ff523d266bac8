"""Everything that an engineer reads from `tms` exists in Japanese and in English."""

import ast
import inspect
import re
import string
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import click
import pytest
from click.testing import CliRunner

from catalogues import catalogue
from tms_cli import words
from tms_cli.main import tms as group
from tms_config.processes import PURPOSES
from tms_decision.reasons import StillPressed
from tms_reason import texts
from tms_ts.reasons import NoRecord
from tms_ts.run_states import STATES

SERVICES = Path(words.__file__).parents[1]
NOT_DAILY = ("drill", "user.py", "palette.py", "panel.py", "prometheus.py", "monitoring.py", "reasons.py",
             "terrain.py", "replay", "open_store.py")  # fmt: skip
KEPT = {  # what is stored, what is found in a task (also in JSON), and parts of errors
    "software stop by an operator", "Two buckets into a truck, which hauls them",
    "it cannot be stored as a task: ", "this is no task: ", "its outermost element is <",
    "it has a TreeNodesModel only (a palette for Groot)", "there is no <BehaviorTree> in it",
    "in it or its folders", "in it (--recursive looks into its folders, too)", "there is no question '",
    "has said nothing for ", "was restarted and does not know the run any more",
    "tms:sp says nothing: is `sp` under services: of the site file, and does `tms ps` show it running?",
    "metrics of ", "embedded store", "another program",
}  # fmt: skip
SAID, HELP = catalogue("tms_cli_words"), catalogue("tms_cli_help")
SENTENCE = re.compile(r"[a-z]{2,} [a-z]{2,}")
CODE = re.compile(r"[A-Z]+(_[A-Z]+)+|BUSY|CONFLICT|FAILED|AMBIGUOUS|PREFLIGHT")


def sources(package: str = "tms_cli") -> Iterator[tuple[Path, ast.Module]]:
    for file in sorted((SERVICES / package).rglob("*.py")):
        yield file, ast.parse(file.read_text(encoding="utf-8"))


def name_of(call: ast.Call) -> str:
    return call.func.attr if isinstance(call.func, ast.Attribute) else getattr(call.func, "id", "")


def said(package: str = "tms_cli") -> set[str]:
    """The English of every `say`, also where it is first given a name or comes from the table of processes."""
    found = set(PURPOSES.values()) if package == "tms_cli" else set()
    for _, tree in sources(package):
        named = {
            target.id: node.value.value
            for node in ast.walk(tree)
            if isinstance(node, ast.Assign) and isinstance(node.value, ast.Constant)
            for target in node.targets
            if isinstance(target, ast.Name)
        }
        for node in ast.walk(tree):
            if isinstance(node, ast.Call) and name_of(node) == "say":
                first = node.args[0]
                if ast.unparse(first) != "row.purpose":  # one of PURPOSES
                    found.add(first.value if isinstance(first, ast.Constant) else named[ast.unparse(first)])
    return {text for text in found if isinstance(text, str)}


def fields(text: str) -> set[tuple[str, str]]:
    return {(name, form or "") for _, name, form, _ in string.Formatter().parse(text) if name is not None}


def commands() -> Iterator[tuple[list[str], click.Command]]:
    waiting: list[tuple[list[str], click.Command]] = [([], group)]
    while waiting:
        path, command = waiting.pop()
        yield path, command
        if isinstance(command, click.Group):
            ctx = click.Context(command)
            for name in command.list_commands(ctx):
                verb = command.get_command(ctx, name)
                assert verb is not None
                waiting.append(([*path, name], verb))


def test_every_line_has_its_japanese_with_the_same_values() -> None:
    assert said() <= set(texts.catalogue("ja"))
    assert set(SAID) - said() <= {*STATES, "idle", "Usage", "Options", "Commands", "Example:", "Examples:"}
    for english, japanese in SAID.items():
        assert fields(english) == fields(japanese), english
        assert japanese, english


def test_every_text_of_the_daily_report_has_its_japanese() -> None:
    known = catalogue("tms_report")
    assert set(known) == said("tms_report")
    assert [english for english, japanese in known.items() if fields(english) != fields(japanese)] == []


def test_no_command_prints_a_sentence_of_its_own() -> None:
    wrong = []
    for file, tree in sources():
        if any(part in str(file.relative_to(SERVICES)) for part in NOT_DAILY):
            continue
        for text in spoken(tree):
            if SENTENCE.search(text) and text not in KEPT and text not in SAID:
                wrong.append(f"{file.name}: {text}")
    assert not wrong, "say() these, with their Japanese in tms_cli_words.po"


def spoken(node: ast.AST) -> Iterator[str]:
    """Texts outside docstrings, errors (reasons), options (they have HELP) and say()."""
    for child in ast.iter_child_nodes(node):
        text_alone = isinstance(child, ast.Expr) and isinstance(child.value, ast.Constant)
        call = name_of(child) if isinstance(child, ast.Call) else ""
        if text_alone or isinstance(child, ast.Raise) or call in ("say", "option", "control_command"):
            continue
        if call.endswith(("Error", "fail", "_wait")):
            continue
        if isinstance(child, ast.Constant) and isinstance(child.value, str):
            yield child.value
        yield from spoken(child)


def test_every_help_page_is_in_both_languages(monkeypatch: pytest.MonkeyPatch) -> None:
    known = {"Show this message and exit."}
    for path, command in commands():
        paragraphs = inspect.cleandoc(command.help or "").split("\n\n")
        mine = {" ".join(text.split()) for text in paragraphs if not text.startswith("\b")}
        mine |= {option.help for option in command.params if isinstance(option, click.Option) and option.help}
        assert mine <= set(HELP), path
        known |= mine
        monkeypatch.setenv("LC_ALL", "C.UTF-8")
        english = CliRunner().invoke(group, [*path, "--help"], terminal_width=100).output
        assert "Usage:" in english and not re.search("[ぁ-んァ-ヶ]", english), path
        monkeypatch.setenv("LC_ALL", "ja_JP.UTF-8")
        page = CliRunner().invoke(group, [*path, "--help"], terminal_width=100).output
        assert "使い方:" in page and "オプション:" in page, path
        prose = page.partition("\n")[2].split("例:")[0] + page.partition("オプション:")[2]
        assert not SENTENCE.search(re.sub("`.*?`|Load palette from file", "", prose)), (path, page)
        assert ("例:" in page) == ("Example" in english), path
    assert known == set(HELP), "Japanese of help that is gone"


def test_every_error_of_a_command_is_a_reason() -> None:
    """A sentence in its place would be shown in English to everybody."""
    wrong = []
    for file, tree in sources():
        for node in ast.walk(tree):
            if isinstance(node, ast.Call) and name_of(node) in ("TmsError", "ConfigError", "TaskError", "RosError"):
                first = node.args[0]
                if isinstance(first, ast.JoinedStr | ast.Constant):
                    wrong.append(f"{file.name}:{node.lineno}")
    assert wrong == []


@pytest.mark.parametrize(
    ("names", "wanted"),
    [
        ({"LANG": "ja_JP.UTF-8"}, True),
        ({"LANG": "ja_JP.UTF-8", "LC_MESSAGES": "en_GB.UTF-8"}, False),
        ({"LC_MESSAGES": "ja_JP.UTF-8", "LC_ALL": "C.UTF-8"}, False),
        ({"LC_ALL": "", "LANG": "ja_JP.UTF-8"}, True),
        ({}, False),
    ],
)
def test_the_locale_decides(names: dict[str, str], wanted: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("LC_ALL", "LC_MESSAGES", "LANG"):
        monkeypatch.delenv(name, raising=False)
    for name, value in names.items():
        monkeypatch.setenv(name, value)
    assert words.japanese() is wanted


def test_an_error_and_its_remedy_and_no_word_of_it_in_json(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LC_ALL", "ja_JP.UTF-8")
    call = [sys.executable, "-m", "tms_cli.main"]
    end = subprocess.run([*call, "task", "add", "/nowhere/task.xml"], capture_output=True, text=True, check=False)
    assert end.returncode == 1
    assert re.search("[ぁ-んァ-ヶ]", end.stderr) and not SENTENCE.search(
        end.stderr.replace("No such file or directory", "")
    )
    in_japanese = subprocess.run([*call, "check", "--json"], capture_output=True, check=True).stdout
    monkeypatch.setenv("LC_ALL", "C.UTF-8")
    assert subprocess.run([*call, "check", "--json"], capture_output=True, check=True).stdout == in_japanese


def test_japanese_lines_are_folded_by_columns() -> None:
    assert words._folded("機械を止める。動く", 12) == "機械を止める。\n動く"
    assert words.padded("成功", 6) == "成功  "


def test_a_finding_has_the_command_that_helps_and_no_advice_without_one(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LC_ALL", "C.UTF-8")
    missing = "no record zx200/gone; Add the record: `tms param set zx200/gone --create FIELD=VALUE`"
    assert words.with_command(NoRecord("zx200/gone")) == missing
    assert words.with_command(StillPressed()) == texts.text(StillPressed(), "en")
