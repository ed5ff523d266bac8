"""What it costs to add something: each row of the table of CONTRIBUTING.md, done to a copy of the project."""

import json
import os
import re
import shutil
import subprocess
import sys
import urllib.request
from collections.abc import Iterator
from pathlib import Path

import pytest
import yaml
from playwright.sync_api import expect

from browsers import chromium
from conftest import PROJECT, Mesh, ports_of, running, site_data

pytestmark = [pytest.mark.system, pytest.mark.timeout(200)]
LIMIT = 60_000  # ms for what a page shows
GUIDE = (PROJECT / "CONTRIBUTING.md").read_text(encoding="utf-8")
TABLE = GUIDE.partition("## What it costs to add\n")[2].partition("\n## ")[0]
ROWS = {name.strip() for name in re.findall(r"^\| ([a-z][^|]*)\|", TABLE, re.MULTILINE)} - {"thing"}
SUBTASK, PAUSE = re.findall(r"```python\n(.*?)```", GUIDE, re.DOTALL)
(LINE,) = re.findall(r"```yaml\n(  st_zx200_lift: lift\n)```", GUIDE)
NODE = '''"""Say a word and count how often."""

from prometheus_client import Counter

from tms_ts.bt.leaf import SyncAction
from tms_ts.bt.ports import In
from tms_ts.bt.registry import node
from tms_ts.bt.status import SUCCESS, Status

GREETINGS = Counter("tms_greetings_total", "Words that were said")


@node
class Greet(SyncAction):
    """Say a word.

    word: what to say
    """

    __slots__ = ()
    word: In[str]

    def tick(self) -> Status:
        GREETINGS.inc()
        return SUCCESS
'''
VERB = '''"""`tms hello`: say it."""

import click


@click.command()
def command() -> None:
    """Say hello."""
    click.echo("hello")
'''
PAGE = """// Hello: how many machines there are.
import { useTranslation } from "react-i18next";
import { useLive } from "../live";

export default function HelloPage() {
  const { t } = useTranslation();
  const { state } = useLive();
  return (
    <>
      <h2>{t("p_hello")}</h2>
      <p id="hello_machines">{state?.machines.length}</p>
    </>
  );
}
"""
TEXTS = '    "p_hello": "Hello",\n    "f_nodes": "Number of nodes",\n'  # in both languages
FIELD = '        facts.values["nodes"] = len(tree.nodes)\n'
SENSING = "\n  height: {topic: /height, type: sensing_msgs/msg/Sample}\n"
TREE = (
    '<root main_tree_to_execute="T"><BehaviorTree ID="T"><Sequence><Greet word="good morning"/><Pause seconds="0.2"/>'
    '<Action ID="LeafNodeZx200" model_name="zx200_2" record_name="high" subtask_name="st_zx200_lift"/>'
    "</Sequence></BehaviorTree></root>"
)


class Copy(Mesh):
    """A mesh of a copied project."""

    @property
    def env(self) -> dict[str, str]:
        return {**super().env, "PYTHONPATH": str(self.site.parent / "services")}

    def tms(self, *words: str, expect: int | None = 0, limit: float = 90) -> "subprocess.CompletedProcess[str]":
        command = [sys.executable, "-m", "tms_cli.main", *words]
        done = subprocess.run(command, env=self.env, capture_output=True, text=True, timeout=limit, check=False,
                              cwd=self.site.parent)  # fmt: skip
        assert expect is None or done.returncode == expect, done.stdout + done.stderr
        return done


def insert(file: Path, line: str, behind: str, times: int = 1) -> None:
    """Put `line` behind each of the `times` lines that begin with `behind`."""
    text, found = re.subn(rf"^ *{re.escape(behind)}.*\n", lambda here: here[0] + line, file.read_text(), flags=re.M)
    assert found == times, f"{file}: {found} lines begin with {behind}"
    file.write_text(text)


def add(project: Path) -> set[str]:
    """One of each; returns the rows of the table that this covers."""
    services, machines = project / "services", project / "configs" / "machines"
    (services / "tms_subtasks" / "lift.py").write_text(SUBTASK)
    (services / "tms_ts" / "nodes" / "greet.py").write_text(NODE)
    (services / "tms_ts" / "nodes" / "pause.py").write_text(PAUSE)
    (services / "tms_cli" / "commands" / "hello.py").write_text(VERB)
    page = services / "tms_ur" / "console" / "src" / "hello" / "hello_page.tsx"
    page.parent.mkdir()
    page.write_text(PAGE)
    insert(services / "tms_ur" / "static" / "words.js", TEXTS, behind='"p_tasks":', times=2)
    insert(services / "tms_ts" / "execution.py", FIELD, behind="facts.machines, facts.records = ")
    (machines / "zx210.yaml").write_text((machines / "zx200.yaml").read_text() + LINE)
    with (project / "configs" / "sensing.yaml").open("a") as inputs:
        inputs.write(SENSING)
    return {
        "subtask",
        "machine model",
        "machine of a site",
        "node of trees",
        "behaviour of py_trees",
        "verb of `tms`",
        "metric",
        "sensing input",
        "console page",
        "field of a run",
    }


def build_console(project: Path) -> None:
    """As `make console` does; with the packages that are here already."""
    (project / "node_modules").symlink_to(PROJECT / "node_modules")
    path = f"{PROJECT / '.venv-console' / 'bin'}:{os.environ['PATH']}"
    command = ["npm", "--silent", "run", "build"]
    subprocess.run(
        command, cwd=project / "services" / "tms_ur" / "console", env={**os.environ, "PATH": path}, check=True
    )


def look(copy: Copy, run: str, nodes: int) -> None:
    """The console has a link to the new page, which is filled, and the new field of the run."""
    address = f"http://127.0.0.1:{yaml.safe_load(copy.site.read_text())['ports']['console']}"
    with urllib.request.urlopen(f"{address}/api/runs", timeout=10) as answer:
        assert json.load(answer)[0]["values"] == {"nodes": nodes}
    with chromium() as browser:
        page = browser.new_page(locale="en-GB")
        page.goto(f"{address}/#hello")
        expect(page.locator("#pages a[href='#hello']")).to_have_text("Hello", timeout=LIMIT)
        expect(page.locator("#hello_machines")).to_have_text("1", timeout=LIMIT)
        page.goto(f"{address}/#history/{run}")
        expect(page.locator("#past_values li")).to_have_text(f"Number of nodes: {nodes}", timeout=LIMIT)


@pytest.fixture
def copy(own_domain: int, tmp_path: Path) -> Iterator[Copy]:
    """The project with one more of each, and a site with a machine of the new model."""
    project = tmp_path / "project"
    for part in ("services", "configs", "deploy"):
        shutil.copytree(PROJECT / part, project / part, ignore=shutil.ignore_patterns("interfaces", "__pycache__"))
    (project / ".venv-store").symlink_to(PROJECT / ".venv-store")
    added = add(project)
    build_console(project)
    assert added | {"reason"} == ROWS  # tests/contract/test_reasons.py walks every reason
    data = site_data(own_domain, ports_of(own_domain), name="copy", machines={"zx200_2": {"model": "zx210"}})
    (project / "site.yaml").write_text(yaml.safe_dump(data))
    made = Copy(project / "site.yaml", tmp_path / "state")
    with running(made):
        yield made


@pytest.mark.turns
def test_one_of_each_is_added_and_works(copy: Copy, tmp_path: Path) -> None:
    copy.tms("param", "set", "zx200_2/high", "--create", "--type", "static", "boom=-1.0")
    (tmp_path / "tree.xml").write_text(TREE)
    copy.tms("task", "add", str(tmp_path / "tree.xml"))
    done = copy.tms("run", "1", "--wait", "--json", expect=None)
    assert json.loads(done.stdout)["outcome"] == "success", done.stdout + done.stderr
    (run,) = json.loads(copy.tms("runs", "--json").stdout)
    nodes = run["values"]["nodes"]
    assert nodes >= 4
    look(copy, run["run_id"], nodes)
    assert copy.tms("hello").stdout == "hello\n"
    palette = copy.tms("palette").stdout
    assert 'ID="Greet"' in palette and 'ID="Pause"' in palette
    assert "height" in {row["name"] for row in json.loads(copy.tms("sensing", "--json").stdout)}
    (port,) = [row["port"] for row in json.loads(copy.tms("ps", "--json").stdout) if row["name"] == "tms:ts"]
    with urllib.request.urlopen(f"http://127.0.0.1:{port}/metrics", timeout=10) as page:
        assert "tms_greetings_total 1.0" in page.read().decode()
