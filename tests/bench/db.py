"""The way to the database: one parameter read, many tasks registered. The group `sensing` has the updates.

The record is one that nobody changes, read again and again as leaves do. Floors: the same read from a bare rclpy
service that has the answer at hand; as many documents stored by bare pymongo, one after another.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import Any

import pymongo
from tms_msg_db.srv import AddTask

from bench.rig.mesh import at, rig
from bench.runner import Figure
from tms_ros.node import Ros

READS, TASKS = 500, 1000
TURNS = 4
SETTLE = 2.0  # s; until tms:db hears of changes in the store, it asks it for each record anew
AT_ONCE = 50  # requests under way
TASK = '<root main_tree_to_execute="M"><BehaviorTree ID="M"><WaitForClick n="{}"/></BehaviorTree></root>'
USUAL_TASKS = 1.1  # s that a usual PC needs for the floor of TASKS
LIMIT = 120.0


def measure() -> Iterable[Figure]:
    with rig(services={"db": {}, "host": {}}, machines={}) as own, own.node() as ros:
        own.mesh.tms("up")
        own.mesh.tms("param", "set", "zx200/BENCH", "--create", "--type", "static", "x=1.0")
        with own.beside("serve"):
            time.sleep(SETTLE)
            floor, read = list[float](), list[float]()
            for _ in range(TURNS):  # by turns, as a PC may become slower meanwhile
                floor += own.bare("get", "/bare/get", "m", "r", str(READS // TURNS))
                read += own.bare("get", "/tms/db/get_parameter", "zx200", "BENCH", str(READS // TURNS))
            floor, read = sorted(floor), sorted(read)
        yield Figure("parameter read p50", "ms", at(0.5, read), 2 * at(0.5, floor), at(0.5, floor))
        yield Figure("parameter read p99", "ms", at(0.99, read), 25.0, at(0.99, floor), usual_floor=1.0)
        with _rows(f"mongodb://127.0.0.1:{own.site.file.ports.store}/?directConnection=true") as rows:
            bare = _store(rows, range(TASKS // 2))  # half before and half after: by turns as well
            registered = _register(ros)
            bare += _store(rows, range(TASKS // 2, TASKS))
        yield Figure(f"{TASKS} tasks registered", "s", registered, 1.0, bare, usual_floor=USUAL_TASKS)


def _register(ros: Ros) -> float:
    """Seconds to register tasks, some at once; an answer with an error ends the benchmark."""
    numbers, refused, taking = iter(range(TASKS)), list[str](), threading.Lock()

    def work() -> None:
        while True:
            with taking:
                number = next(numbers, None)
            if number is None or refused:
                return
            request = AddTask.Request(task_sequence=TASK.format(number))
            answer = ros.call(AddTask, "/tms/db/add_task", request, LIMIT)
            if answer.error_code:
                refused.append(answer.error_msg)

    workers = [threading.Thread(target=work) for _ in range(AT_ONCE)]
    begun = time.perf_counter()
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join(LIMIT)
    assert not refused, refused[0]
    return time.perf_counter() - begun


@contextmanager
def _rows(uri: str) -> Iterator[Any]:
    """A collection with the indexes of tasks."""
    with pymongo.MongoClient(uri, w="majority", journal=True) as client:
        rows = client["bench"]["rows"]
        for key in ("task_id", "text_sha256"):
            rows.create_index(key, unique=True)
        yield rows
        client.drop_database("bench")


def _store(rows: Any, some: range) -> float:
    """Seconds for as many bare documents."""
    begun = time.perf_counter()
    for number in some:
        rows.insert_one({"task_id": number, "text_sha256": f"{number:064}", "task_sequence": TASK.format(number)})
    return time.perf_counter() - begun
