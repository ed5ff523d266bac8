"""`make simulate` runs compiled: the same source, through mypyc, takes half the time.

The product, the tests and the mutants run the plain source, and so does the simulation where nothing can be compiled.
Compiled or not, a seed has the same history: that is looked at before a new build is used.
"""

import hashlib
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterable
from importlib.metadata import version
from pathlib import Path
from tempfile import TemporaryDirectory

import click

from simulation.schedule import Schedule

TESTS = Path(__file__).resolve().parents[1]
PROJECT = TESTS.parent
SERVICES = PROJECT / "services"
PACKAGES = (SERVICES / "tms_decision", SERVICES / "tms_proof", TESTS / "simulation")
# Data (see tms_decision/data.py) and reasons are made while Python runs, which mypyc does not know of; and programs.
PLAIN = re.compile(r"^class \w+\((?:Data|Event|Effect|Reason)\b|^if __name__ ==", re.MULTILINE)
WORTH = 1_000  # schedules; fewer are done before a new build is
SEEDS = range(7_000, 7_010)  # their histories must be the same
HISTORIES = "from simulation.compiled import SEEDS, histories; print(histories(SEEDS))"
STAMP = "built-from"


class CannotCompile(Exception):
    """Says why."""


def sources() -> dict[str, str]:
    """The text of each module, by its place below the folder of its package."""
    found = [(path, package.parent) for package in PACKAGES for path in sorted(package.rglob("*.py"))]
    return {str(path.relative_to(parent)): path.read_text(encoding="utf-8") for path, parent in found}


def modules(texts: dict[str, str]) -> list[str]:
    """Those that are compiled."""
    names = [name for name, text in texts.items() if not PLAIN.search(text)]
    return [name for name in names if not Path(name).name.startswith(("test_", "__init__"))]


def stamp(texts: dict[str, str]) -> str:
    """What a build depends on."""
    return hashlib.sha256(repr((sorted(texts.items()), sys.version, version("mypy"))).encode()).hexdigest()


def histories(seeds: Iterable[int]) -> str:
    """The digest of what happens with these seeds."""
    told = (line for seed in seeds for line in Schedule(seed).run().history)
    return hashlib.sha256("\n".join(map(str, told)).encode()).hexdigest()


def write(folder: Path, texts: dict[str, str]) -> None:
    """Write the sources into a folder."""
    for name, text in texts.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")


def build(folder: Path, names: list[str]) -> None:
    """Compile modules of the folder, beside their sources; raises CannotCompile."""
    environment = {**os.environ, "MYPYPATH": str(SERVICES), "MYPYC_OPT_LEVEL": "1", "MYPYC_DEBUG_LEVEL": "0"}
    _call(folder, ["-m", "mypyc", "--config-file", str(PROJECT / "pyproject.toml"), *names], environment)


def check(folder: Path) -> None:
    """Raises CannotCompile when what happens there is not what happens here."""
    if _call(folder, ["-c", HISTORIES], dict(os.environ)).strip() != histories(SEEDS):
        raise CannotCompile("its histories are not those of plain Python")


def _call(folder: Path, arguments: list[str], environment: dict[str, str]) -> str:
    done = subprocess.run([sys.executable, *arguments], cwd=folder, env=environment, capture_output=True, text=True)
    if done.returncode:
        lines = (done.stdout + done.stderr).strip().splitlines()[-3:]
        raise CannotCompile("\n".join(line[:150] for line in lines))  # commands of compilers are longer
    return done.stdout


def place(folder: Path, schedules: int) -> Path:
    """Where to run: in the folder with a build of the present sources, else in `tests`."""
    texts = sources()
    if (folder / STAMP).exists() and (folder / STAMP).read_text() == stamp(texts):
        return folder
    if schedules < WORTH:
        return TESTS
    click.echo("compiling the simulation, once until a source of it changes (a minute or two)", err=True)
    with TemporaryDirectory(prefix="simulation-", dir=folder.parent) as name:
        made = Path(name) / "built"
        try:
            write(made, texts)
            build(made, modules(texts))
            check(made)
        except CannotCompile as problem:
            click.echo(f"not compiled, so it takes twice as long: {problem}", err=True)
            return TESTS
        (made / STAMP).write_text(stamp(texts))
        shutil.rmtree(folder, ignore_errors=True)
        made.rename(folder)
    return folder


@click.command()
@click.argument("folder", type=click.Path(path_type=Path, resolve_path=True))
@click.option("--schedules", "-n", default=15_000, show_default=True, help="How many will be run.")
def main(folder: Path, schedules: int) -> None:
    """Print the folder in which to run the simulation, after compiling it into FOLDER if need be."""
    click.echo(place(folder, schedules))


if __name__ == "__main__":
    main()
