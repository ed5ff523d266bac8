"""Nodes of another system: rclpy and the C++ system's definitions, in processes that have no code of this project."""

import os
import signal
import subprocess
import sys
import sysconfig
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from conftest import PROJECT, Mesh
from tms_config.config import load_site
from tms_runtime.environment import environment

SCRIPT = str(PROJECT / "tests" / "data" / "upstream_client.py")
SUCCEEDED, ABORTED = "4", "6"


def their_environment(mesh: Mesh, form: str = "v5") -> dict[str, str]:
    """ROS settings of the mesh, and the paths of a form of theirs; our own code is not on them."""
    ours = environment(load_site(str(mesh.site)))
    kept = {key: ours[key] for key in ours if key.startswith(("ROS_", "FASTRTPS_", "HOME"))}
    if form != "v5":
        prefix = Path(sys.prefix) / "share" / "tms_forms" / form
        kept["PYTHONPATH"] = str(prefix / Path(sysconfig.get_path("purelib")).relative_to(sys.prefix))
        kept["LD_LIBRARY_PATH"] = f"{prefix / 'lib'}:{os.environ['LD_LIBRARY_PATH']}"
    return {**{key: value for key, value in os.environ.items() if key != "PYTHONPATH"}, **kept}


def ask(mesh: Mesh, *words: str, form: str = "v5") -> list[str]:
    """What one goal of theirs came to: status, result, and the words of the last feedback."""
    done = subprocess.run([sys.executable, SCRIPT, *words], env=their_environment(mesh, form), capture_output=True,
                          text=True, timeout=90, check=True, cwd="/")  # fmt: skip
    return done.stdout.split()


@contextmanager
def asking(mesh: Mesh, *words: str, form: str = "v5") -> Iterator[None]:
    """One goal of theirs that is at work meanwhile."""
    command, environ = [sys.executable, SCRIPT, *words], their_environment(mesh, form)
    with subprocess.Popen(command, env=environ, stdout=subprocess.DEVNULL, cwd="/") as client:
        try:
            yield
        finally:
            client.send_signal(signal.SIGKILL)


@contextmanager
def foreign_server(mesh: Mesh, *words: str, form: str = "v5") -> Iterator["subprocess.Popen[str]"]:
    """A server of theirs (`serve MACHINE SUBTASK`, `planner MACHINE`), which prints each goal."""
    command = [sys.executable, SCRIPT, *words]
    environ = their_environment(mesh, form)
    with subprocess.Popen(command, env=environ, stdout=subprocess.PIPE, text=True, cwd="/") as server:
        assert server.stdout is not None and server.stdout.readline() == "ready\n"
        try:
            yield server
        finally:
            server.send_signal(signal.SIGKILL)
