"""The `tms` commands of the README and of the console's guide work as they stand, one after the other."""

import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from rosbags.rosbag2 import StoragePlugin, Writer
from sensing_msgs.msg import Sample

from conftest import PROJECT, Mesh
from tms_cli.replay.matching import built_hash
from tms_ros.packing import pack

pytestmark = pytest.mark.system

README = "".join((PROJECT / name).read_text() for name in ("README.md", "deploy/CONSOLE.md"))
BLOCKS = re.findall(r"```sh\n(.*?)```", README, re.DOTALL)
TMS = [line.split("#")[0].strip() for block in BLOCKS for line in block.splitlines() if line.startswith("tms ")]


def record(folder: Path) -> None:
    """The recording that the README plays."""
    kind = "sensing_msgs/msg/Sample"
    with Writer(folder, version=9, storage_plugin=StoragePlugin.SQLITE3) as bag:
        sample = bag.add_connection("/sample", kind, msgdef="", rihs01=built_hash(kind))
        bag.write(sample, 1_000_000_000, pack(Sample(model_name="zx200", record_name="sample")))


def test_the_tms_commands_in_their_order(mesh: Mesh, tmp_path: Path) -> None:
    assert len(TMS) > 10
    folder = Path(sys.executable).parent
    env = {**mesh.env, "PATH": f"{folder}:{os.environ['PATH']}"}
    shutil.copytree(PROJECT / "configs", tmp_path / "configs")  # some commands write there
    record(tmp_path / "rosbag2_2026_04_01")
    for line in TMS:
        cancels = line == "tms cancel last"  # the run before it may have ended by then
        done = subprocess.run(
            ["sh", "-c", line],
            env=env,
            cwd=tmp_path,
            input="a long password\n" * 2 if line.startswith("tms user add") else "y\n",
            capture_output=True,
            text=True,
            timeout=90,
            check=False,
        )
        over = cancels and ("is active" in done.stderr or "success" in done.stdout)
        assert done.returncode == 0 or over, f"{line}\n{done.stdout}\n{done.stderr}"
        assert shlex.split(line)[0] == "tms"
