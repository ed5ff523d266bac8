"""The way to the database: one parameter read and written, many tasks registered.

Floors: the same read from a bare rclpy service that has the answer at hand; the same writes by bare pymongo.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterable
from typing import Any

import pymongo
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from tms_msg_db.srv import AddTask, SetParameter

from bench.rig.mesh import at, rig
from bench.runner import Figure
from tms_core.ros import Ros

READS, WRITES, TASKS = 500, 1000, 1000
AT_ONCE = 20  # requests under way
TASK = '<root main_tree_to_execute="M"><BehaviorTree ID="M"><WaitForClick n="{}"/></BehaviorTree></root>'
LIMIT = 120.0


def measure() -> Iterable[Figure]:
    with rig(services={"db": {}, "host": {}}, machines={}) as own, own.node() as ros:
        own.mesh.tms("up")
        _set(ros, 1)
        with own.beside("serve"):
            floor = own.bare("get", "/bare/get", "m", "r", str(READS))
            read = own.bare("get", "/tms/db/get_parameter", "zx200", "BENCH", str(READS))
        yield Figure("read p50", "ms", at(0.5, read), 2 * at(0.5, floor), at(0.5, floor))
        yield Figure("read p99", "ms", at(0.99, read), 25.0, at(0.99, floor), usual_floor=1.0)
        bare_writes, bare_tasks = _floors(f"mongodb://127.0.0.1:{own.site.file.ports.store}/?directConnection=true")
        yield Figure(f"{WRITES} updates", "s", _set(ros, WRITES), 1.0, bare_writes)
        yield Figure(f"{TASKS} tasks", "s", _add(ros), 1.0, bare_tasks)


def _set(ros: Ros, count: int) -> float:
    def request(number: int) -> Any:
        value = ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=float(number))
        return SetParameter.Request(
            model_name="zx200", record_name="BENCH", type="dynamic", source="bench", create=True,
            values=[Parameter(name="x", value=value)],
        )  # fmt: skip

    return _many(ros, SetParameter, "/tms/db/set_parameter", request, count)


def _add(ros: Ros) -> float:
    return _many(ros, AddTask, "/tms/db/add_task", lambda n: AddTask.Request(task_sequence=TASK.format(n)), TASKS)


def _many(ros: Ros, kind: Any, name: str, request: Callable[[int], Any], count: int) -> float:
    """Seconds for many calls, some of them under way at once; an answer with an error ends the benchmark."""
    numbers, refused, taking = iter(range(count)), [], threading.Lock()

    def work() -> None:
        while True:
            with taking:
                number = next(numbers, None)
            if number is None or refused:
                return
            answer = ros.call(kind, name, request(number), LIMIT)
            if answer.error_code:
                refused.append(answer.error_msg)

    workers = [threading.Thread(target=work) for _ in range(min(AT_ONCE, count))]
    begun = time.perf_counter()
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join(LIMIT)
    assert not refused, refused[0]
    return time.perf_counter() - begun


def _floors(uri: str) -> tuple[float, float]:
    """Seconds for the same number of updates and of inserts, one after another."""
    with pymongo.MongoClient(uri, w="majority", journal=True) as client:
        rows = client["bench"]["rows"]
        rows.create_index("key", unique=True)
        rows.insert_one({"key": 0})
        begun = time.perf_counter()
        for number in range(WRITES):
            rows.update_one({"key": 0}, {"$set": {"x": float(number)}})
        middle = time.perf_counter()
        for number in range(1, TASKS + 1):
            rows.insert_one({"key": number, "text": TASK.format(number)})
        ended = time.perf_counter()
        client.drop_database("bench")
    return middle - begun, ended - middle
