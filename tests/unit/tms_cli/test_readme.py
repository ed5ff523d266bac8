"""What README and guides show works: their subtask loads, its commands and make targets exist."""

import importlib.util
import re
import shlex
import sys
from pathlib import Path
from types import ModuleType

import click
import pytest

from tms_cli.main import tms
from tms_config.config import PROJECT
from tms_kit.subtask import Subtask
from tms_ts.bt import Registry, Status, load, palette, registry

PAGES = {name: (PROJECT / name).read_text(encoding="utf-8") for name in (
    "README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "deploy/CONSOLE.md", "deploy/OPERASIM.md",
    "deploy/OPERASIM.ja.md", "deploy/WORK.md", "deploy/WORK.ja.md", "configs/README.md",
)}  # fmt: skip
README = "\n".join(PAGES.values())
SUBTASK, BEHAVIOUR = re.findall(r"```python\n(.*?)```", README, re.DOTALL)
COMMANDS = sorted(
    {line for block in re.findall(r"```sh\n(.*?)```", README, re.DOTALL) for line in block.splitlines()}
    | set(re.findall(r"`(tms [a-z][^`]*)`", README))
)


def words(line: str) -> list[str]:
    return shlex.split(line.split(" > ")[0].split(" and ")[0], comments=True)[1:]


@pytest.mark.parametrize("line", [line for line in COMMANDS if line.startswith("tms ")])
def test_commands_of_the_readme_parse(line: str) -> None:
    command: click.Command = tms
    given = words(line)
    context = click.Context(tms)
    while isinstance(command, click.Group) and (given or not command.invoke_without_command):
        name = given.pop(0)
        found = command.get_command(context, name)
        assert found is not None, f"there is no `{name}` in `{line}`"
        command = found
    command.make_context(command.name, given, parent=context)


def test_make_targets_of_the_readme_exist() -> None:
    makefile = (PROJECT / "Makefile").read_text(encoding="utf-8")
    targets = set(re.findall(r"^\.PHONY: (.*)$", makefile, re.MULTILINE)[0].split())
    assert set(re.findall(r"(?:`|^)make ([a-z][a-z-]*)", README, re.MULTILINE)) <= targets


def test_both_languages_of_the_readme_show_the_same() -> None:
    japanese = (PROJECT / "README.ja.md").read_text(encoding="utf-8")
    for shown in (r"```sh\n(.*?)```", r"^\| (`(?:make|TMS)[^|]*?) \|"):
        parts = [re.findall(shown, page, re.DOTALL | re.MULTILINE) for page in (PAGES["README.md"], japanese)]
        ours, theirs = ([re.sub(r"#.*", "", part) for part in found] for found in parts)
        assert [re.sub(r"\s+\n", "\n", one) for one in ours] == [re.sub(r"\s+\n", "\n", one) for one in theirs]
        assert ours
    japanese = re.sub(r"\.ja\.(png|md)\)", r".\1)", japanese)  # the same pages
    assert re.findall(r"\]\(([^)]+)\)", japanese)[1:] == re.findall(r"\]\(([^)]+)\)", PAGES["README.md"])[1:]


def test_the_readme_is_short() -> None:
    assert len(PAGES["README.md"].splitlines()) <= 200


def made(code: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """A module of the guide."""
    (folder / "made.py").write_text(code)
    spec = importlib.util.spec_from_file_location("made", folder / "made.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    monkeypatch.setitem(sys.modules, "made", module)  # its type hints are looked up there
    spec.loader.exec_module(module)
    return module


def test_the_subtask_of_the_guide_is_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    kind = made(SUBTASK, tmp_path, monkeypatch).lift.subtask
    assert issubclass(kind, Subtask)
    assert kind.params.model_validate({"boom": -1.0}).boom == -1.0


def test_the_behaviour_of_py_trees_of_the_guide_is_a_node(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    registry()  # else the nodes that are imported for the first time below would be forgotten with this test
    nodes = sys.modules[Registry.__module__]
    monkeypatch.setattr(nodes, "_recorded", dict(nodes._recorded))  # it is a node of this test only
    made(BEHAVIOUR, tmp_path, monkeypatch)
    tree = load('<root><BehaviorTree ID="T"><Pause seconds="60"/></BehaviorTree></root>')
    assert tree.tick() is Status.RUNNING
    tree.halt()
    assert 'ID="Pause"' in palette()


def test_links_of_the_readme_lead_somewhere() -> None:
    for name, page in PAGES.items():
        for target in re.findall(r"\]\(([^)#:]+)\)", page):
            assert ((PROJECT / name).parent / target).exists(), f"{name}: {target}"
