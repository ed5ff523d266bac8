"""Files and functions stay short enough to be read at once."""

import ast
from pathlib import Path

import pytest

from conftest import PROJECT

FILES, FUNCTIONS = 300, 40  # lines
PYTHON = sorted(path for path in (PROJECT / "services").rglob("*.py"))


@pytest.mark.parametrize("path", PYTHON, ids=lambda path: str(path.relative_to(PROJECT / "services")))
def test_its_sizes(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    assert len(text.splitlines()) <= FILES, "split the file"
    made = (ast.FunctionDef, ast.AsyncFunctionDef)
    functions = [node for node in ast.walk(ast.parse(text)) if isinstance(node, made)]
    long = [node.name for node in functions if (node.end_lineno or 0) - node.lineno + 1 > FUNCTIONS]
    assert long == [], "split the functions"
