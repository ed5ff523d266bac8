"""A process that speaks another form starts anew with the paths of that form first, once."""

import os
from typing import Any

import pytest

from tms_runtime import wire_form


def test_the_form_stands_before_the_usual_packages(monkeypatch: pytest.MonkeyPatch) -> None:
    started: list[tuple[list[str], dict[str, str]]] = []

    def execve(_: str, words: list[str], env: dict[str, str]) -> Any:
        started.append((words, env))

    monkeypatch.setattr(os, "execve", execve)
    monkeypatch.setattr("sys.argv", ["run.py", "zx200:if"])
    monkeypatch.setenv("PYTHONPATH", "/opt/tms/services")
    monkeypatch.setenv("LD_LIBRARY_PATH", "/opt/lib")
    wire_form.enter("v6b")
    ((words, env),) = started
    prefix = str(wire_form.PREFIXES / "v6b")
    assert words[1:] == ["-m", "tms_runtime.run", "zx200:if"]
    assert env["LD_LIBRARY_PATH"] == f"{prefix}/lib:/opt/lib"
    assert env["PYTHONPATH"].startswith(prefix) and env["PYTHONPATH"].endswith("site-packages:/opt/tms/services")
    monkeypatch.setenv("PYTHONPATH", env["PYTHONPATH"])
    wire_form.enter("v6b")
    assert len(started) == 1
