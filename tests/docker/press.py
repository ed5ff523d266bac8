"""Runs inside the container of the cps PC: presses the software stop and tells what the gateway's receipts say of it.

Prints the milliseconds from each press to the gateway's command, by the clock that all containers share.
"""

import json
import sys
import threading
import time
from typing import Any

from std_msgs.msg import Bool
from tms_msg_rc.msg import StopReceipt

from tms_core import environment
from tms_core.config import load_site

LIMIT = 10.0  # s for a receipt


def main(machine: str, presses: int) -> list[float]:
    environment.enter(load_site())
    from tms_core.ros import Ros

    ros = Ros("press")
    came = threading.Condition()
    receipts: list[float] = []  # when each stop was commanded, s

    def heard(receipt: Any) -> None:
        with came:
            receipts.append(receipt.stamp.sec + receipt.stamp.nanosec * 1e-9)
            came.notify_all()

    button = ros.publisher(Bool, "/emergency_signal", depth=10)
    ros.subscribe(StopReceipt, f"/{machine}/rc/receipts", heard, latched=True)
    found = []
    try:
        deadline = time.monotonic() + LIMIT
        while button.get_subscription_count() < 2 and time.monotonic() < deadline:  # gateway and scheduler
            time.sleep(0.02)
        with came:
            for _ in range(presses):
                found.append(_press(button, came, receipts))
    finally:
        button.publish(Bool(data=False))
        ros.close()
    return found


def _press(button: Any, came: threading.Condition, receipts: list[float]) -> float:
    pressed = time.time()
    button.publish(Bool(data=True))
    if not came.wait_for(lambda: bool(receipts) and max(receipts) >= pressed, LIMIT):
        raise SystemExit("no receipt")
    button.publish(Bool(data=False))
    return round(1000 * (min(stamp for stamp in receipts if stamp >= pressed) - pressed), 2)


if __name__ == "__main__":
    print(json.dumps(main(sys.argv[1], int(sys.argv[2]))))
