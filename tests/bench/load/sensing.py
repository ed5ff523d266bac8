"""The processes around the sensing benchmark: `publish`, `read` while it publishes, and what is there at the end."""

from __future__ import annotations

import json
import random
import sys
import time
from typing import Any

from bench.sensing import RATE, RECORDS, SECONDS, TOPIC
from tms_config.config import load_site
from tms_runtime import environment

LIMIT = 20.0  # s
PROBE = "/bench/probe"
PAUSE = 0.001  # s between looks; without it the reader itself keeps tms:db busy


def publish(ros: Any) -> dict[str, float]:
    """Each message carries its number of the record in x and its time (monotonic) in y; returns the last numbers."""
    from sensing_msgs.msg import ExcavateSimple
    from std_msgs.msg import Float64

    publisher, probe = ros.publisher(ExcavateSimple, TOPIC, depth=1000), ros.publisher(Float64, PROBE)
    ros.wait_for(lambda: publisher.get_subscription_count() > 0, LIMIT, "nobody hears")
    time.sleep(1.0)  # the reader starts
    last = dict.fromkeys((f"r{i}" for i in range(RECORDS)), 0.0)
    begin, sent = time.monotonic(), 0
    while sent < RATE * SECONDS:
        due = min(RATE * SECONDS, int((time.monotonic() - begin) * RATE))
        while sent < due:
            name = f"r{sent % RECORDS}"
            last[name] += 1.0
            publisher.publish(
                ExcavateSimple(model_name="bench", record_name=name, x=last[name], y=time.monotonic(), z=0.0)
            )
            sent += 1
        probe.publish(Float64(data=time.monotonic()))
        time.sleep(0.002)
    time.sleep(1.0)
    return last


def read(ros: Any) -> dict[str, float]:
    """p99 [ms] from publish to read, and p99 [ms] of one hop from process to process without anything in between."""
    from std_msgs.msg import Float64
    from tms_msg_db.srv import GetParameter

    def values(name: str) -> tuple[float, float]:
        request = GetParameter.Request(model_name="bench", record_name=name)
        answer = ros.call(GetParameter, "/tms/db/get_parameter", request, LIMIT)
        fields = {value.name: value.value.double_value for value in answer.record.values}
        return fields["x"], fields["y"]

    took: list[float] = []
    hops: list[float] = []
    ros.subscribe(Float64, PROBE, lambda message: hops.append(time.monotonic() - message.data), depth=10)
    while values("r0")[0] == 0.0:
        time.sleep(0.02)
    end = time.monotonic() + SECONDS - 2.0
    while time.monotonic() < end:
        name = f"r{random.randrange(RECORDS)}"
        before = values(name)[0]
        while time.monotonic() < end:
            number, sent = values(name)
            now = time.monotonic()
            if number > before:
                took.append(now - sent)
                break
            time.sleep(PAUSE)
    return {"p99": p99(took), "hop": p99(hops)}


def p99(times: list[float]) -> float:
    return 1000 * sorted(times)[int(0.99 * len(times))]


def final(ros: Any) -> dict[str, float]:
    """Numbers of all records after the last message."""
    from tms_msg_db.srv import ListParameters

    answer = ros.call(ListParameters, "/tms/db/list_parameters", ListParameters.Request(), LIMIT)
    return {
        record.record_name: next(value.value.double_value for value in record.values if value.name == "x")
        for record in answer.records
    }


if __name__ == "__main__":
    environment.enter(load_site())
    from tms_ros.node import Ros

    node = Ros(f"bench_{sys.argv[1]}")
    print(json.dumps({"publish": publish, "read": read, "final": final}[sys.argv[1]](node)))
    node.close()
