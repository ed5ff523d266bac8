"""Continues frozen processes at a moment: `python -m tms_cli.drill.thaw SECONDS_SINCE_1970 PID [PID ...]`.

This is a separate program because the threads of the drill were up to 3 s late on a busy PC.
"""

import os
import signal
import sys

from tms_config.clock import sleep, unix_time


def main(until: float, pids: list[int]) -> None:
    """Wait, and send SIGCONT to the processes that have not ended."""
    sleep(max(0.0, until - unix_time()))
    for pid in pids:
        try:
            os.kill(pid, signal.SIGCONT)
        except ProcessLookupError:
            continue


if __name__ == "__main__":
    main(float(sys.argv[1]), [int(word) for word in sys.argv[2:]])
