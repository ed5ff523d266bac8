"""The site guide's trial: four containers with Compose and nothing but the commands that it names."""

import json
import os
import subprocess
from collections.abc import Iterator

import pytest
from docker_site import DOCKER, docker

from conftest import PROJECT, wait_until

pytestmark = [pytest.mark.docker, pytest.mark.turns, pytest.mark.timeout(400, func_only=True)]
PCS = ("cps", "machine", "sensing", "sim")


def make(target: str) -> None:
    argv = ["make", target, "SITE=trial", "ROLE=trial", "RUNTIME=docker", f"DOCKER={DOCKER}"]
    done = subprocess.run(argv, cwd=PROJECT, env=os.environ, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def tms(pc: str, *argv: str) -> subprocess.CompletedProcess[str]:
    return docker("exec", f"tms-trial-{pc}", "tms", *argv, limit=120, expect=None)


@pytest.fixture(scope="module")
def trial(image: None) -> Iterator[None]:
    volumes = [f"tms-trial_{pc}" for pc in PCS]
    if docker("volume", "inspect", *volumes, expect=None).stdout.strip() != "[]":
        pytest.skip("somebody's own trial is here")
    try:
        make("up")
        yield
    finally:
        make("down")
        docker("volume", "rm", *volumes, expect=None)


def test_the_trial_of_the_guide_runs_a_task(trial: None) -> None:
    for pc in PCS:
        wait_until(lambda pc=pc: tms(pc, "status").returncode == 0, 120, f"{pc} is ready", 2.0)  # type: ignore[misc]
    for argv in (
        ("rearm", "zx200", "--yes"),
        ("param", "load", "configs/parameters/zx200.yaml"),
        ("task", "add", "configs/tasks/one_loading_cycle.xml"),
    ):
        assert tms("cps", *argv).returncode == 0
    done = tms("cps", "run", "1", "--wait", "--json")
    assert json.loads(done.stdout)["outcome"] == "success", done.stderr
