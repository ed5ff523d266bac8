"""Files and functions stay short enough to be read at once, and the packages below all services small."""

import ast
from pathlib import Path

import pytest

from conftest import PROJECT

FILES, FUNCTIONS = 300, 40  # lines
LOWER = {"tms_reason": 1300, "tms_proof": 1300, "tms_decision": 2500, "tms_config": 1300, "tms_ros": 1300,
         "tms_runtime": 1300, "tms_machine": 1300}  # fmt: skip
PYTHON = sorted(path for path in (PROJECT / "services").rglob("*.py"))


@pytest.mark.parametrize("path", PYTHON, ids=lambda path: str(path.relative_to(PROJECT / "services")))
def test_its_sizes(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    assert len(text.splitlines()) <= FILES, "split the file"
    made = (ast.FunctionDef, ast.AsyncFunctionDef)
    functions = [node for node in ast.walk(ast.parse(text)) if isinstance(node, made)]
    long = [node.name for node in functions if (node.end_lineno or 0) - node.lineno + 1 > FUNCTIONS]
    assert long == [], "split the functions"


@pytest.mark.parametrize("package", LOWER)
def test_the_size_of_a_package_that_all_services_use(package: str) -> None:
    files = [path for path in PYTHON if path.is_relative_to(PROJECT / "services" / package)]
    lines = sum(len(path.read_text(encoding="utf-8").splitlines()) for path in files)
    assert files and lines <= LOWER[package], "move what one service uses to that service, or further up or down"
