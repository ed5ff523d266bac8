"""`python reading.py`: a sensing PC that publishes readings of a record for ever, with their number in x."""

from __future__ import annotations

import itertools
import time

from sensing_msgs.msg import ExcavateSimple

from tms_config.config import load_site
from tms_ros.node import Ros
from tms_runtime import environment

TOPIC, INPUT = "/soak/reading", "reading"
RECORD = {"model_name": "soak", "record_name": "reading", "type": "dynamic", "x": 0.0, "y": 0.0, "z": 0.0}
SENSING = {"inputs": {INPUT: {"topic": TOPIC, "type": "sensing_msgs/msg/ExcavateSimple", "depth": 200}}}
RATE = 50.0  # 1/s


def main() -> None:
    environment.enter(load_site())
    publisher = Ros("soak_sensing").publisher(ExcavateSimple, TOPIC, depth=100)
    for number in itertools.count(1):
        publisher.publish(ExcavateSimple(model_name="soak", record_name="reading", x=float(number), y=0.0, z=0.0))
        time.sleep(1 / RATE)


if __name__ == "__main__":
    main()
