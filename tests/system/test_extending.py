"""A subtask is one file and one line (those of CONTRIBUTING.md), a machine one line: done to a copy of the project."""

import json
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
import yaml

from conftest import PROJECT, Mesh, ports_of, running, site_data

pytestmark = [pytest.mark.system, pytest.mark.timeout(200)]
GUIDE = (PROJECT / "CONTRIBUTING.md").read_text(encoding="utf-8")
(FILE,) = re.findall(r"```python\n(.*?)```", GUIDE, re.DOTALL)
(LINE,) = re.findall(r"```yaml\n(  st_zx200_lift: lift\n)```", GUIDE)
TREE = (
    '<root main_tree_to_execute="T"><BehaviorTree ID="T"><Action ID="LeafNodeZx200" model_name="zx200_2" '
    'record_name="high" subtask_name="st_zx200_lift"/></BehaviorTree></root>'
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


@pytest.fixture
def copy(own_domain: int, tmp_path: Path) -> Iterator[Copy]:
    """The project with one file and one line more, and a site with one more machine."""
    project = tmp_path / "project"
    for part in ("services", "configs", "deploy"):
        shutil.copytree(PROJECT / part, project / part, ignore=shutil.ignore_patterns("interfaces", "__pycache__"))
    (project / ".venv-store").symlink_to(PROJECT / ".venv-store")
    (project / "services" / "tms_subtasks" / "lift.py").write_text(FILE)
    with (project / "configs" / "machines" / "zx200.yaml").open("a") as model:
        model.write(LINE)
    data = site_data(own_domain, ports_of(own_domain), name="copy", machines={"zx200_2": {"model": "zx200"}})
    (project / "site.yaml").write_text(yaml.safe_dump(data))
    made = Copy(project / "site.yaml", tmp_path / "state")
    with running(made):
        yield made


def test_one_file_and_one_line_each(copy: Copy, tmp_path: Path) -> None:
    copy.tms("param", "set", "zx200_2/high", "--create", "--type", "static", "boom=-1.0")
    (tmp_path / "tree.xml").write_text(TREE)
    copy.tms("task", "add", str(tmp_path / "tree.xml"))
    done = copy.tms("run", "1", "--wait", "--json", expect=None)
    assert json.loads(done.stdout)["outcome"] == "success", done.stdout + done.stderr
