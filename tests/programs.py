"""Programs of ours as forks of a process that has loaded their libraries, as those of supervisord are.

A test run starts more than a thousand of them, and most of what a short one costs goes into imports.
"""

import multiprocessing
import os
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from multiprocessing.process import BaseProcess
from pathlib import Path

import pytest

import forked

FORKS = multiprocessing.get_context("forkserver")
FORKS.set_forkserver_preload(["loaded", "forked"])


class Program:
    """A running program of ours; what it writes is appended to files."""

    def __init__(
        self, become: Callable[..., None], words: tuple[str, ...], env: dict[str, str], out: Path, err: Path
    ) -> None:
        self._words, self._files = words, (out, err)
        for path in self._files:
            path.touch()
        self._process = self._started(become, env)

    def _started(self, become: Callable[..., None], env: dict[str, str]) -> BaseProcess:
        with pytest.MonkeyPatch.context() as patch:  # the first one starts the process that is forked
            patch.setenv("PYTHONPATH", os.pathsep.join(str(forked.PROJECT / name) for name in ("services", "tests")))
            process = FORKS.Process(target=become, args=(self._words, env, *self._files))
            process.start()
        return process

    @property
    def pid(self) -> int:
        assert self._process.pid is not None  # it was started
        return self._process.pid

    @property
    def returncode(self) -> int | None:
        """Its exit code by now, None while it runs."""
        return self._process.exitcode

    def wait(self, limit: float) -> int:
        """Its exit code; subprocess.TimeoutExpired if it runs for longer than `limit` [s]."""
        self._process.join(limit)
        if (code := self._process.exitcode) is None:
            raise subprocess.TimeoutExpired(self._words, limit, *(path.read_bytes() for path in self._files))
        return code

    def written(self) -> tuple[str, str]:
        """What it has written to its output, and to the one for errors."""
        out, err = (path.read_text() for path in self._files)
        return out, err

    def output(self, limit: float) -> str:
        """What it has written until its end, at most `limit` [s] from now."""
        self.wait(limit)
        return self.written()[0]

    def terminate(self) -> None:
        self._process.terminate()

    def kill(self) -> None:
        self._process.kill()


def process(name: str, env: dict[str, str], log: Path, become: Callable[..., None] = forked.be_process) -> Program:
    """Start the process of a mesh that is named so."""
    return Program(become, (name,), env, log, log)


@contextmanager
def running_tms(*words: str, env: dict[str, str]) -> Iterator[Program]:
    """`tms` with these words; it is killed at the end, if it still runs then."""
    with tempfile.TemporaryDirectory() as folder:
        client = Program(forked.be_tms, words, env, Path(folder, "out"), Path(folder, "err"))
        try:
            yield client
        finally:
            client.kill()
            client.wait(10)


def tms(words: tuple[str, ...], env: dict[str, str], limit: float) -> "subprocess.CompletedProcess[str]":
    """Run `tms` with these words; subprocess.TimeoutExpired if it takes longer than `limit` [s]."""
    with running_tms(*words, env=env) as client:
        code = client.wait(limit)
        return subprocess.CompletedProcess(["tms", *words], code, *client.written())
