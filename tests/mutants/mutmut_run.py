"""`make mutmut`: small changes of the proof and of the latch, one at a time; the unit tests must fail for each.

mutmut makes them from the code, in hundreds; those of the catalogue (`make mutants`) are written by hand, and the
simulation looks for them. What survives is harmless, and `survivors.yaml` says why.
"""

import os
import re
import shutil
import subprocess
import sys
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

import click
import yaml

TESTS = Path(__file__).resolve().parents[1]
PROJECT = TESTS.parent
JUDGED = Path(__file__).with_name("survivors.yaml")
LEAST = 0.9  # share that the tests must kill
KILLED = ("killed", "timeout")
CHANGED = ("src/tms_proof", "src/tms_decision/latch.py")
TESTED = ("unit/tms_proof", "unit/tms_decision")
NEEDED = (*TESTED, "unit/conftest.py", "simulation", "conftest.py", "programs.py", "sharing.py", "turns.py",
          "examples.py", "loaded.py", "forked.py", "words.py")  # fmt: skip
SETTINGS = f"""[tool.mutmut]
source_paths = {list(CHANGED)}
also_copy = ["src", "configs"]
pytest_add_cli_args_test_selection = {[f"tests/{one}" for one in TESTED]}
[tool.pytest.ini_options]
pythonpath = ["src", "tests"]
addopts = "--import-mode=importlib -p no:randomly -p no:cacheprovider --hypothesis-seed=0"
markers = ["ros", "system", "browser", "docker"]
"""
RESULT = re.compile(r"^\s+(\S+)\.x(?:ǁ(\w+)ǁ|_)(\w+)__mutmut_\d+: (.+)$")


@dataclass(frozen=True)
class Judged:
    """Why so many changes of a function are harmless."""

    count: int
    why: str


def judged(path: Path = JUDGED) -> dict[str, Judged]:
    """What may survive of each function."""
    return {name: Judged(**one) for name, one in yaml.safe_load(path.read_text(encoding="utf-8")).items()}


def lay_out(folder: Path) -> None:
    """Copies of code and tests where mutmut finds them: it wants packages directly below `src`."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    no_caches = shutil.ignore_patterns("__pycache__", "interfaces")
    shutil.copytree(PROJECT / "services", folder / "src", ignore=no_caches)
    shutil.copytree(PROJECT / "configs", folder / "configs")
    for name in NEEDED:
        here, there = TESTS / name, folder / "tests" / name
        there.parent.mkdir(parents=True, exist_ok=True)
        if here.is_dir():
            shutil.copytree(here, there, ignore=no_caches)
        else:
            shutil.copy(here, there)
    (folder / "pyproject.toml").write_text(SETTINGS, encoding="utf-8")


def tested(folder: Path, workers: int) -> list[str]:
    """Each change, and what has become of it."""
    mutmut = [sys.executable, "-m", "mutmut"]
    if subprocess.run([*mutmut, "run", "--max-children", str(workers)], cwd=folder).returncode:
        raise click.ClickException("mutmut has ended before all changes were tested; its last lines say why")
    told = subprocess.run([*mutmut, "results", "--all", "1"], cwd=folder, capture_output=True, text=True, check=True)
    return told.stdout.splitlines()


def read(lines: Iterable[str]) -> tuple[int, Counter[str]]:
    """How many changes there were, and of each function, how many have survived."""
    found = [match.groups() for line in lines if (match := RESULT.match(line))]
    left = Counter(".".join(filter(None, parts)) for *parts, status in found if status not in KILLED)
    return len(found), left


def unjudged(left: Mapping[str, int], known: Mapping[str, Judged]) -> list[str]:
    """Functions of which more has survived than was judged."""
    return [
        f"{name}: {count} survived, {known[name].count if name in known else 0} are judged"
        for name, count in sorted(left.items())
        if name not in known or count > known[name].count
    ]


@click.command()
@click.argument("folder", type=click.Path(path_type=Path))
@click.option("--workers", default=os.cpu_count() or 1, show_default=True, help="Changes that are tested side by side.")
def main(folder: Path, workers: int) -> None:
    """Change proof and latch in a copy below FOLDER; the unit tests must fail for 9 of 10 changes.

    Exit code 1 if they fail for fewer, or if more changes of a function survive than survivors.yaml judges.

    \b
    Examples:
      make mutmut                                    seven minutes of two cores
      cd .venv/mutmut && ../bin/mutmut show NAME     one of those that it has named
    """
    lay_out(folder)
    lines = tested(folder, workers)
    count, left = read(lines)
    killed = count - left.total()
    for line in [*(line.strip() for line in lines if not line.endswith(KILLED)), *(wrong := unjudged(left, judged()))]:
        click.echo(line)
    click.echo(f"{count} changes, {killed} killed ({killed / max(count, 1):.1%}), {left.total()} survived")
    sys.exit(1 if wrong or not count or killed < LEAST * count else 0)


if __name__ == "__main__":
    main()
