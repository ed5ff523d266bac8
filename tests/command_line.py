"""Runs `tms` as a process of its own: a fork of one that has loaded its libraries, as supervisord's programs are.

A test run calls `tms` some hundred times, and half of the time of a call goes into imports.
"""

import multiprocessing
import os
import subprocess
import sys
import tempfile
from multiprocessing.process import BaseProcess
from pathlib import Path

import pytest

PROJECT = Path(__file__).resolve().parents[1]
FORKS = multiprocessing.get_context("forkserver")
FORKS.set_forkserver_preload(["loaded"])


def call(words: tuple[str, ...], env: dict[str, str], limit: float) -> "subprocess.CompletedProcess[str]":
    """Run `tms` with these words; subprocess.TimeoutExpired if it takes longer than `limit` [s]."""
    with tempfile.TemporaryDirectory() as folder:
        out, err = Path(folder) / "out", Path(folder) / "err"
        process = _started(words, env, out, err)
        process.join(limit)
        if process.exitcode is None:
            process.kill()
            process.join()
            raise subprocess.TimeoutExpired(["tms", *words], limit, out.read_bytes(), err.read_bytes())
        return subprocess.CompletedProcess(["tms", *words], process.exitcode, out.read_text(), err.read_text())


def _started(words: tuple[str, ...], env: dict[str, str], out: Path, err: Path) -> BaseProcess:
    for path in (out, err):
        path.touch()
    with pytest.MonkeyPatch.context() as patch:  # the first call starts the process that is forked
        patch.setenv("PYTHONPATH", os.pathsep.join((str(PROJECT / "services"), str(PROJECT / "tests"))))
        process = FORKS.Process(target=_become, args=(words, env, out, err))
        process.start()
    return process


def _become(words: tuple[str, ...], env: dict[str, str], out: Path, err: Path) -> None:
    """Be `tms`, in the fork."""
    for number, path in ((1, out), (2, err)):
        file = os.open(path, os.O_WRONLY | os.O_APPEND)
        os.dup2(file, number)
        os.close(file)
    os.environ.clear()
    os.environ.update(env)
    os.chdir(PROJECT)
    sys.argv = ["tms", *words]
    from tms_cli.main import main

    main()
