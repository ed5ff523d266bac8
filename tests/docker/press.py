"""Runs inside the container of the cps PC: presses the software stop as the console does, again and again.

Prints the seconds from each press to the gateway's command: the stamp of the receipt, by the clock of all containers.
"""

import json
import sys
import time

from tms_msg_rc.srv import StopMachine

from tms_config.config import load_site
from tms_ros.node import Ros
from tms_runtime import environment
from tms_runtime.last_resort import end_after

LIMIT = 10.0  # s for a receipt


def main(machine: str, presses: int) -> None:
    environment.enter(load_site())
    ros = Ros("press")
    ros.call(StopMachine, f"/{machine}/rc/stop", StopMachine.Request(cause="test"), LIMIT)  # found each other
    waits = [press(ros, machine) for _ in range(presses)]
    print(json.dumps(waits), flush=True)
    end_after(LIMIT, 0)
    ros.close()


def press(ros: Ros, machine: str) -> float:
    pressed = time.time()
    answer = ros.call(StopMachine, f"/{machine}/rc/stop", StopMachine.Request(cause="test"), LIMIT)
    stamp = answer.receipt.stamp
    return round(stamp.sec + stamp.nanosec * 1e-9 - pressed, 4)


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))
