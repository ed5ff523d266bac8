"""Machines at the level of messages: what a scheduler sees of gateways and subtasks, many of them in one process.

python crowd.py NAME SUBTASK,... MACHINE...

Prints `ready`; after a stop, when no goal is open any more, one line: the time stamps [ns] at which each machine heard
it and at which its goal was asked to end (0: it had none), as JSON.
"""

from __future__ import annotations

import json
import sys
import threading
import time
from typing import Any

from std_msgs.msg import Bool
from tms_msg_rc.msg import MachineState, StopReceipt
from tms_msg_rc.srv import StopMachine
from tms_msg_ts.action import LeafNodeBase

from tms_config.config import load_site
from tms_machine.permit import Permit
from tms_ros.goals import Ended, Outcome
from tms_ros.node import Ros
from tms_ros.server import Goal
from tms_runtime import environment
from tms_runtime.priority import come_first, threads
from tms_runtime.pulse import Pulse
from tms_runtime.run import OF_A_MACHINE

STATE_PERIOD = 0.2  # s, as gateways tell their states
WORK = 10.0  # s that a goal takes
GATEWAY = bytes([255]) * 16
LOOK = 0.1  # s


class Machine:
    """One of them."""

    def __init__(self, ros: Ros, name: str, subtasks: list[str]) -> None:
        self.name, self._ros = name, ros
        self.on_press = self.ended = 0  # ns since 1970, of the last stop
        self._latch = ""
        self.open = 0  # goals
        self._states = ros.publisher(MachineState, f"/{name}/rc/state", depth=1, latched=True)
        self._permit = Permit(ros, Pulse(ros), name, "rc")
        self._permit.hold(GATEWAY)
        ros.offer(StopMachine, f"/{name}/rc/stop", self._stop)
        for subtask in subtasks:
            ros.serve(LeafNodeBase, f"/{name}/{subtask}", self._work)

    def report(self) -> None:
        self._states.publish(MachineState(machine=self.name, ready=True, armed=not self._latch, latch=self._latch))

    def press(self, message: Any, received: int) -> None:
        if message.data and not self._latch:
            self.on_press, self._latch = received, "software stop"
        elif not message.data:
            self._latch = ""
        self.report()

    def _stop(self, request: Any, response: Any) -> Any:
        response.receipt = StopReceipt(machine=self.name, confirmed=True, cause=request.cause, stamp=self._ros.now())
        return response

    def _work(self, goal: Goal) -> Ended:
        self.open += 1
        cancelled = goal.cancelled.wait(WORK)
        self.open -= 1
        if cancelled:
            self.ended = time.time_ns()
            return Outcome.CANCELED, LeafNodeBase.Result()
        return Outcome.SUCCEEDED, LeafNodeBase.Result(result=True)


def main(name: str, subtasks: str, *names: str) -> None:
    environment.enter(load_site())
    ros = Ros(f"crowd_{name}")
    machines = [Machine(ros, machine, subtasks.split(",")) for machine in names]

    def on_press(message: Any, info: Any) -> None:
        for machine in machines:
            machine.press(message, int(info["received_timestamp"]))  # not when one thread of ten machines came to it
        if message.data:
            threading.Thread(target=report, daemon=True).start()

    def report() -> None:
        while any(machine.open for machine in machines):
            time.sleep(LOOK)
        print(json.dumps([[machine.on_press, machine.ended] for machine in machines]), flush=True)

    def news() -> None:
        for machine in machines:
            machine.report()

    ros.node.create_subscription(Bool, "/emergency_signal", on_press, 1, callback_group=ros.loop.group)
    ros.every(STATE_PERIOD, news)
    nice, realtime = OF_A_MACHINE  # as their subtasks have; a gateway has more
    come_first(nice, threads(), realtime)
    print("ready", flush=True)
    threading.Event().wait()


if __name__ == "__main__":
    main(*sys.argv[1:])
