"""A site whose PCs run schedulers only; its machines are at the level of messages (bench/rig/crowd.py)."""

import json
import subprocess
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import psutil
from docker_site import DOCKER, Yard

from bench.rig.dispatcher import END_LIMIT, LIMIT, SUBTASKS
from bench.scale import A_PROCESS, CROWD, after_press
from tms_config.processes import Process
from tms_schedulers.names import MAIN

FIRST, *OTHERS = "cps", "north", "east", "south"  # PCs


class Fleet(Yard):
    """Machines dealt out to the schedulers of four PCs."""

    def __init__(self, run: str, folder: Path, machines: int) -> None:
        names = [f"m{number}" for number in range(machines)]
        self.shares = {pc: names[i :: 1 + len(OTHERS)] for i, pc in enumerate((FIRST, *OTHERS))}
        pcs: dict[str, dict[str, Any]] = {FIRST: {"roles": ["cps", "machine", "sensing", "sim"]}}
        pcs |= {pc: {"roles": ["scheduler"], "machines": self.shares[pc]} for pc in OTHERS}
        site = {"services": {"db": {}, "ts": {}}, "machines": {name: {"model": "zx200"} for name in names}}
        super().__init__(run, folder, pcs, **site)
        self._wanted = {FIRST: ["tms:store", "tms:db", MAIN], **{pc: [f"{MAIN}_{pc}"] for pc in OTHERS}}
        self.rows = tuple(row for row in self.rows if row.full in self._wanted[row.pc])

    def create(self) -> None:
        """The containers; there are no tasks and nothing to arm."""
        self.start()

    def _start(self, pc: str, *_: Any) -> None:
        options = ["--interactive", "--entrypoint", "python", "--volume", f"{CROWD.parent}:/rig:ro"]
        super()._start(pc, options, ["/rig/forks.py", *self._wanted[pc]])

    @property
    def schedulers(self) -> dict[Process, int]:
        """Each with its pid on this PC."""
        return {row: self._pid(row) for row in self.rows if row.full.startswith(MAIN)}

    def _pid(self, row: Process) -> int:
        below = psutil.Process(self.pid(row.pc)).children(recursive=True)
        return next(one.pid for one in below if " ".join(one.cmdline()).endswith(f" {row.full}"))

    @contextmanager
    def crowds(self) -> Iterator[list[subprocess.Popen[str]]]:
        """All machines, each on the PC of its scheduler; ten at a time, as a site does not appear at once."""
        with ExitStack() as stack:
            crowds = []
            for pc, names in self.shares.items():
                for i in range(0, len(names), A_PROCESS):
                    words = names[i], ",".join(SUBTASKS), *names[i : i + A_PROCESS]
                    crowds.append(stack.enter_context(self._program(pc, "crowd.py", *words)))
                    assert _line(crowds[-1]) == "ready"
            yield crowds

    @contextmanager
    def going(self, runs: int, crowds: list[subprocess.Popen[str]]) -> Iterator[subprocess.Popen[str]]:
        """All runs go."""
        with self._program(FIRST, "dispatcher.py", str(runs), str(len(crowds))) as dispatcher:
            assert _line(dispatcher) == "going"
            yield dispatcher

    @contextmanager
    def _program(self, pc: str, name: str, *words: str) -> Iterator[subprocess.Popen[str]]:
        argv = [DOCKER, "exec", "--interactive", self.name(pc), "python", f"/rig/{name}", *words]
        with subprocess.Popen(argv, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as program:
            try:
                yield program
            finally:
                program.kill()


def press(dispatcher: subprocess.Popen[str], crowds: list[subprocess.Popen[str]]) -> tuple[float, float, int]:
    """The software stop: ms until the last machine has heard it and the last goal ends; runs that are left then."""
    told = json.loads(dispatcher.communicate(timeout=LIMIT + END_LIMIT)[0])
    return *after_press(told["pressed"], crowds), told["left"]


def _line(program: subprocess.Popen[str]) -> str:
    assert program.stdout is not None
    return program.stdout.readline().strip()
