"""Two schedulers on PCs of their own: the second runs the tasks of its machine, the first where that one is away."""

import json
from typing import Any

import pytest
from docker_site import LOOK, Yard, docker

from conftest import wait_until

pytestmark = [pytest.mark.docker, pytest.mark.turns, pytest.mark.timeout(400, func_only=True)]


def newest(yard: Yard) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(yard.tms("cps", "runs", "--limit", "1", "--json").stdout)[0]
    return found


def test_a_task_of_its_machine_is_run_by_the_second(yard_of_two: Yard) -> None:
    assert yard_of_two.run("1")["outcome"] == "success"
    assert newest(yard_of_two)["run_id"].endswith("-north")


def test_the_loss_of_its_pc_stops_the_machine_and_the_first_takes_the_next_task(yard_of_two: Yard) -> None:
    yard = yard_of_two
    run = yard.begin("2")
    yard.wait_moving()
    docker("kill", yard.name("north"))
    latched = lambda: [line for line in yard.stops() if "latched=True" in line]  # noqa: E731
    wait_until(lambda: bool(latched()), 30, "the machine was stopped", LOOK)
    assert "confirmed=True" in latched()[-1]
    run.communicate(timeout=90)
    lost = newest(yard)["run_id"]
    yard.rearm()
    answers: list[dict[str, Any]] = []
    wait_until(lambda: answers.append(yard.run("1")) or answers[-1]["outcome"] == "success", 90, f"{answers}")
    assert not newest(yard)["run_id"].endswith("-north")
    docker("start", yard.name("north"))
    yard.wait_ready("north")
    row = lambda: json.loads(yard.tms("cps", "runs", "--json").stdout)  # noqa: E731
    ended = lambda: next(one["state"] for one in row() if one["run_id"] == lost)  # noqa: E731
    wait_until(lambda: ended() == "interrupted", 60, "its run is closed")
    yard.tms("cps", "abandon", lost)
    assert yard.run("1")["outcome"] == "success"
    assert newest(yard)["run_id"].endswith("-north")
