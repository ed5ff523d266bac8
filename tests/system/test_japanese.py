"""The command line in Japanese: runs, stops and refusals show no English sentence, and no name of ROS."""

import json

import pytest
from test_mesh import swinging

from conftest import Mesh
from tms_ros.node import Ros
from words import ROS, english

pytestmark = [pytest.mark.turns, pytest.mark.system]


def foreign(mesh: Mesh, *words: str, expect: int = 0) -> list[str]:
    """Lines of a command in English, or with what only ROS knows; names that people gave to their tasks are theirs."""
    done = mesh.tms(*words, expect=expect)
    given = [task["description"] for task in json.loads(mesh.tms("task", "list", "--json").stdout)]
    lines = [
        line for line in (done.stdout + done.stderr).splitlines() if not any(name in line for name in given if name)
    ]
    return [line for line in lines if english(line) or ROS.search(line)]


def test_a_run_a_stop_and_a_refusal(mesh: Mesh, node: Ros, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LC_ALL", "ja_JP.UTF-8")
    mesh.arm()
    assert foreign(mesh, "run", "1", "--wait") == []
    with swinging(mesh, node) as client:
        assert foreign(mesh, "status") == []
        assert foreign(mesh, "stop") == []
        client.wait(60)
    for words in (("events", "last"), ("runs",)):
        assert foreign(mesh, *words) == []
    assert foreign(mesh, "status") == []
    assert foreign(mesh, "run", "1", "--wait", expect=1) == []
    assert foreign(mesh, "rearm", "zx200", "--yes") == []
