"""A power cut of the drill, with real processes."""

import os
import subprocess
import sys
import time
from pathlib import Path

import psutil
import pytest

from conftest import wait_until
from tms_cli.drill.hits import power_off

CHILD = """
import ctypes, pathlib, signal, sys
ctypes.CDLL(None).prctl(1, signal.SIGTERM)
signal.signal(signal.SIGTERM, lambda *_: pathlib.Path(sys.argv[1], "in_order").touch())
pathlib.Path(sys.argv[1], "ready").touch()
while True:
    signal.pause()
"""
TOP = """
import subprocess, sys
while True:
    subprocess.run([sys.executable, *sys.argv[1:]])
"""


def test_nothing_ends_in_order_or_is_started_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Also where this program gets a processor late, between two signals."""
    sent = os.kill

    def kill(pid: int, number: int) -> None:
        sent(pid, number)
        time.sleep(0.3)

    with subprocess.Popen([sys.executable, "-c", TOP, "-c", CHILD, str(tmp_path)]) as top:
        try:
            wait_until((tmp_path / "ready").exists, 20, "the child is there")
            children = psutil.Process(top.pid).children()
            monkeypatch.setattr(os, "kill", kill)
            power_off([top.pid, *(child.pid for child in children)])
            assert top.wait(10) == -9 and len(children) == 1
            psutil.wait_procs(children, 10)
        finally:
            top.kill()
    assert not (tmp_path / "in_order").exists()
    assert not any(str(tmp_path) in " ".join(one.info["cmdline"] or ()) for one in psutil.process_iter(["cmdline"]))
