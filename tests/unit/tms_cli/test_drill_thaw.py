"""The program that lets frozen processes go on."""

import signal
import subprocess
import sys
import time

import psutil

from conftest import wait_until
from tms_cli.drill import thaw


def test_frozen_processes_go_on_and_one_that_is_gone_harms_nobody() -> None:
    child = subprocess.Popen(["sleep", "60"])
    gone = subprocess.Popen([sys.executable, "-c", "pass"])
    gone.wait()
    try:
        child.send_signal(signal.SIGSTOP)
        wait_until(lambda: psutil.Process(child.pid).status() == psutil.STATUS_STOPPED, 30, "it is frozen")
        began = time.time()
        thaw.main(began + 0.2, [gone.pid, child.pid])
        assert time.time() >= began + 0.2
        wait_until(lambda: psutil.Process(child.pid).status() != psutil.STATUS_STOPPED, 30, "it goes on")
    finally:
        child.kill()
        child.wait()
