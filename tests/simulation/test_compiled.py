"""The compiled simulation: which modules it has, that it is the same, and that plain Python takes its place."""

import subprocess
import sys
from pathlib import Path

import pytest

from simulation import compiled
from simulation.compiled import STAMP, TESTS, WORTH, CannotCompile, build, check, modules, place, sources, stamp, write

SMALL = "tms_proof/stamps.py"  # compiled within seconds


def test_what_python_makes_while_it_runs_is_not_compiled() -> None:
    found = modules(sources())
    assert {"tms_decision/gateway/step.py", "tms_proof/channel.py", "simulation/world.py"} <= {*found}
    assert not {"tms_decision/data.py", "tms_decision/gateway/events.py", "tms_proof/reasons.py"} & {*found}
    assert not [name for name in found if "test_" in name or "__init__" in name]


def test_a_compiled_module_is_used_and_changes_no_history(tmp_path: Path) -> None:
    write(tmp_path, sources())
    build(tmp_path, [SMALL])
    code = "import tms_proof.stamps, tms_decision; print(tms_proof.stamps.__file__, tms_decision.__file__)"
    told = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True).stdout
    first, second = map(Path, told.split())
    assert first.is_relative_to(tmp_path) and first.suffix in (".so", ".pyd")
    assert second == tmp_path / "tms_decision" / "__init__.py"
    check(tmp_path)


def test_other_histories_are_refused(tmp_path: Path) -> None:
    texts = sources()
    other = texts["simulation/world.py"].replace("1 / 0.003", "1 / 0.004")
    assert other != texts["simulation/world.py"]
    write(tmp_path, {**texts, "simulation/world.py": other})
    with pytest.raises(CannotCompile, match="histories"):
        check(tmp_path)


def test_without_a_compiler_it_is_plain_python(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(compiled, "modules", lambda texts: [SMALL])
    monkeypatch.setenv("CC", str(tmp_path / "no-compiler"))
    assert place(tmp_path / "simulation", WORTH) == TESTS
    told = capsys.readouterr().err
    assert "not compiled" in told and "no-compiler" in told
    assert list(tmp_path.iterdir()) == []


def test_it_is_compiled_for_a_long_series_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder, made = tmp_path / "simulation", list[int]()
    monkeypatch.setattr(compiled, "build", lambda folder, names: made.append(len(names)))
    monkeypatch.setattr(compiled, "check", lambda folder: None)
    assert place(folder, WORTH - 1) == TESTS and made == []
    assert [place(folder, WORTH), place(folder, WORTH), place(folder, 1)] == [folder] * 3 and len(made) == 1
    (folder / STAMP).write_text(stamp({**sources(), "simulation/world.py": "changed"}))
    assert place(folder, 1) == TESTS
    assert place(folder, WORTH) == folder and len(made) == 2
