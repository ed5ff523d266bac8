"""Processes of a mesh, forked with their libraries loaded, as supervisord's are: their memory is what it is on a site.

python forks.py PROCESS...

Prints the pids as JSON; the processes are killed when the input ends.
"""

from __future__ import annotations

import json
import os
import signal
import sys

from tms_host import prefork


def _forked(name: str, parent: int) -> int:
    pid = os.fork()
    if pid == 0:
        os.dup2(2, 1)  # what it writes is for the log
        prefork.exec_entry([sys.executable, "-m", prefork.MODULE, name], dict(os.environ), parent)
    return pid


def main() -> None:
    """Until the input ends."""
    prefork.load(sys.argv[1:])
    pids = [_forked(name, os.getpid()) for name in sys.argv[1:]]
    print(json.dumps(pids), flush=True)
    sys.stdin.read()
    for pid in pids:
        os.kill(pid, signal.SIGKILL)
        os.waitpid(pid, 0)


if __name__ == "__main__":
    main()
