"""Every reason has both texts, uses its arguments, and is raised by somebody."""

import re
import subprocess
import sys
from pathlib import Path
from string import Formatter

import pytest

from catalogues import catalogue
from conftest import PROJECT
from tms_reason import remedies, texts, wire
from tms_reason.reason import REGISTRY, Reason

SERVICES = PROJECT / "services"


def printed() -> list[str]:
    """What the command line prints; its own tests look after it."""
    return [english for name in ("tms_cli_words", "tms_cli_help", "tms_report") for english in catalogue(name)]


def declared() -> list[type[Reason]]:
    wire.load()
    return sorted((one for one in REGISTRY.values() if one.__module__.startswith("tms_")), key=lambda one: one.code)


def templates(kind: type[Reason]) -> list[str]:
    return [one for one in (kind.text, kind.details, kind.remedy.text if kind.remedy else "") if one]


def names(template: str) -> set[str]:
    return {name for _, name, _, _ in Formatter().parse(template) if name is not None}


def arguments(kind: type[Reason]) -> set[str]:
    return set(kind.parameters)


@pytest.mark.parametrize("kind", declared(), ids=lambda kind: kind.code)
def test_its_texts(kind: type[Reason]) -> None:
    for template in templates(kind):
        japanese = texts.translated(template, "ja")
        if re.sub(r"{[a-z_0-9]+}", "", template).strip(" :;,.()"):
            assert japanese != template, f"{kind.code}: no Japanese for {template!r}"
        assert names(japanese) == names(template), f"{kind.code}: {japanese!r} has other arguments than {template!r}"
    helps = kind.remedy.command + kind.remedy.text if kind.remedy else ""
    used = names(kind.text) | names(kind.details) | names(helps)
    assert used == arguments(kind), f"{kind.code}: declared {sorted(arguments(kind))}, used {sorted(used)}"


@pytest.mark.parametrize("kind", declared(), ids=lambda kind: kind.code)
def test_its_texts_name_no_command(kind: type[Reason]) -> None:
    """Whoever has the console alone has no terminal; the command of a remedy is shown by `tms` only."""
    if kind.__module__ == "tms_cli.reasons":
        return  # shown by `tms` only
    for template in templates(kind):
        for language in texts.LANGUAGES:
            assert "`tms " not in texts.translated(template, language), f"{kind.code}: {template!r}"


def test_no_code_is_unused_and_no_text_is_left_behind() -> None:
    sources = {
        path: path.read_text(encoding="utf-8")
        for path in SERVICES.rglob("*.py")
        if not path.name.endswith("reasons.py")
    }
    words = set(re.findall(r"\w+", "\n".join(sources.values())))
    assert [kind.code for kind in declared() if kind.__name__ not in words] == []
    wanted = {template for kind in declared() for template in templates(kind)}
    wanted |= {one.text for one in vars(remedies).values() if isinstance(one, remedies.Remedy)}
    assert sorted(set(texts.catalogue("ja")) - wanted - set(printed())) == []


def test_a_module_of_reasons_imports_nothing_but_tms_reason() -> None:
    for path in SERVICES.glob("tms_*/*reasons.py"):
        found = re.findall(r"^(?:from|import) ([\w.]+)", path.read_text(encoding="utf-8"), re.MULTILINE)
        assert {one.partition(".")[0] for one in found} <= {"tms_reason", "typing"}, Path(path).relative_to(SERVICES)


def test_to_know_all_reasons_costs_no_libraries() -> None:
    """Every process loads them at its start: with those of trees came all of py_trees, for half of its time."""
    code = "import sys; from tms_reason import wire; wire.load(); print(*sys.modules)"
    told = subprocess.run([sys.executable, "-c", code], cwd=SERVICES, capture_output=True, text=True, check=True).stdout
    ours = [name for name in told.split() if name.startswith("tms_") and not name.startswith("tms_reason")]
    assert ours and [name for name in ours if "." in name and not name.endswith("reasons")] == []
    assert not {"py_trees", "lxml", "rclpy"} & {*told.split()}
