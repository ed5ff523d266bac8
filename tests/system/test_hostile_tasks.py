"""Malformed or hostile XML at the command line: one clear line, exit code 1, nothing stored."""

import json
from pathlib import Path

import pytest

from conftest import Mesh

pytestmark = pytest.mark.system

LAUGHS = "".join(f'<!ENTITY e{n} "{f"&e{n - 1};" * 10}">' for n in range(1, 10))
BOMB = f'<!DOCTYPE r [<!ENTITY e0 "ha">{LAUGHS}]><root><BehaviorTree ID="T">&e9;</BehaviorTree></root>'


def write(folder: Path, kind: str) -> Path:
    file = folder / "task.xml"
    if kind == "huge":
        with file.open("wb") as out:
            out.truncate(100 * 2**20)  # sparse: the size alone must refuse it
    elif kind == "deep":
        file.write_text("<root><BehaviorTree ID='T'>" + "<Inverter>" * 10_000 + "</Inverter>" * 10_000 +
                        "</BehaviorTree></root>")  # fmt: skip
    elif kind == "bomb":
        file.write_text(BOMB)
    elif kind == "malformed":
        file.write_text("<root><BehaviorTree></root>")
    elif kind == "binary":
        file.write_bytes(b"\xff\xfe<\x00r\x00")
    elif kind == "empty":
        file.write_text("")
    return file


@pytest.mark.parametrize(
    ("kind", "said"),
    [
        ("missing", "task.xml"),
        ("huge", "100.0 MB"),
        ("deep", "nested"),
        ("bomb", "DOCTYPE"),
        ("malformed", "line 1"),
        ("binary", "UTF-8"),
        ("empty", "empty"),
    ],
)
def test_refused(mesh: Mesh, tmp_path: Path, kind: str, said: str) -> None:
    before = json.loads(mesh.tms("task", "list", "--json").stdout)
    done = mesh.tms("task", "add", str(write(tmp_path, kind)), expect=1)
    (line,) = done.stderr.strip().splitlines()
    assert said in line
    assert json.loads(mesh.tms("task", "list", "--json").stdout) == before
