"""The console process with real ROS peers: what is published is shown, commands arrive, and it ends when told."""

import json
import socket
import ssl
import subprocess
import urllib.request
from pathlib import Path
from typing import Any

import pytest
from builtin_interfaces.msg import Time
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from std_msgs.msg import String
from tms_msg_db.msg import Event, PastValues, Record, Run, Task
from tms_msg_db.srv import GetTask, ListEvents, ListParameterHistory, ListParameters, ListRuns, ListTasks
from tms_msg_host.msg import Process, Processes
from tms_msg_rc.msg import MachineState
from tms_msg_sp.msg import InputState, InputStates
from tms_msg_ts.action import ExecuteTask
from tms_msg_ts.msg import RunState, RunStates
from tms_msg_ts.srv import CancelRun

from conftest import wait_until
from console_process import LIMIT, Console, running, spawn
from tms_config.config import Site
from tms_ros.goals import Ended, Outcome
from tms_ros.node import Ros
from tms_ros.server import Goal

pytestmark = pytest.mark.ros


def test_the_certificate_is_beside_the_site_file(site: Site, tmp_path: Path) -> None:
    """And not where somebody happened to start the mesh."""
    subprocess.run(
        ["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2", "-subj", "/CN=localhost",
         "-keyout", str(tmp_path / "key.pem"), "-out", str(tmp_path / "cert.pem")], check=True, capture_output=True,
    )  # fmt: skip
    with site.path.open("a") as file:
        file.write("console: {tls: {certificate: cert.pem, key: key.pem}}\n")
    with running(site, tmp_path) as console:
        ours = ssl.create_default_context(cafile=str(tmp_path / "cert.pem"))
        port = site.file.ports.console
        with urllib.request.urlopen(f"https://localhost:{port}/", timeout=LIMIT, context=ours) as page:
            assert page.status == 200
        assert f"url=https://127.0.0.1:{port} " in console.log.read_text()


def test_the_way_of_a_stop_is_there_before_it_is_needed(console: Console, ros: Ros) -> None:
    wait_until(lambda: ros.node.count_clients("/zx200/rc/stop") == 1, LIMIT, "the console's way to the gateway")


def test_the_editor_knows_the_nodes_that_the_scheduler_tells(console: Console, ros: Ros) -> None:
    assert console.get("/api/palette")["xml"] == ""
    ros.publisher(String, "/tms/palette", depth=1, latched=True).publish(String(data="<root/>"))
    wait_until(lambda: console.get("/api/palette")["xml"] == "<root/>", LIMIT, "the palette has come")


def test_state_shows_what_is_published(console: Console, ros: Ros) -> None:
    state = console.get("/api/state")
    assert state["machines"][0]["state"] == "silent"
    machine = ros.publisher(MachineState, "/zx200/rc/state", depth=1, latched=True)
    runs = ros.publisher(RunStates, "/tms/runs", depth=1, latched=True)
    hosts = ros.publisher(Processes, "/tms/host/processes", depth=10, latched=True)
    moving = MachineState(machine="zx200", ready=True, moving=True, goal="ab", joint_names=["swing_joint"],
                          positions=[-1.5], velocities=[0.25], age=0.1)  # fmt: skip
    run = RunState(
        run_id="r-1", task_id=4, state="running", machines=["zx200"], reason="turning", started_at=Time(sec=9)
    )
    runs.publish(RunStates(runs=[run]))
    for name in ("pc1", "pc2"):
        hosts.publish(Processes(host=name, processes=[Process(name="tms:ts", state="RUNNING", pid=7, uptime=3.0)]))

    def received() -> bool:
        machine.publish(moving)  # again and again: it counts as silent 2 s after its last word
        state = console.get("/api/state")
        return state["machines"][0]["state"] == "moving" and bool(state["runs"]) and len(state["hosts"]) == 2

    wait_until(received, LIMIT, "everything published is in the state")
    state = console.get("/api/state")
    assert state["machines"][0]["joints"] == [{"name": "swing_joint", "position": -1.5, "velocity": 0.25}]
    assert state["scheduler"]["alive"]
    assert (state["runs"][0]["run_id"], state["runs"][0]["reason"]["text"]["en"]) == ("r-1", "turning")
    assert state["runs"][0]["started_at"] == "1970-01-01T00:00:09Z"
    assert console.get("/api/sensing") == {"age": None, "inputs": []}
    inputs = ros.publisher(InputStates, "/tms/sp/inputs", depth=1, latched=True)
    inputs.publish(InputStates(inputs=[InputState(name="pile", age=3.0, refused=2, last_refusal="z: too high")]))
    wait_until(lambda: console.get("/api/sensing")["inputs"], LIMIT, "inputs are heard")
    pile = console.get("/api/sensing")["inputs"][0]
    assert (pile["refused"], pile["last_refusal"]["text"]["en"], pile["age"] >= 3.0) == (2, "z: too high", True)
    assert [host["name"] for host in state["hosts"]] == ["pc1", "pc2"]
    assert state["hosts"][0]["processes"][0]["uptime"] >= 3.0
    wait_until(lambda: console.get("/api/state")["machines"][0]["state"] == "silent", LIMIT, "silence is told")


def refusal(answer: tuple[int, Any]) -> tuple[int, str, str]:
    """Status, code and English text."""
    status, problem = answer
    return status, problem["code"], problem["text"]["en"]


def test_stored_things(console: Console, ros: Ros) -> None:
    task = Task(task_id=4, model_name="zx200", description="掘削", task_sequence="<root/>", added_at=Time(sec=1))
    value = Parameter(
        name="angle", value=ParameterValue(type=ParameterType.PARAMETER_DOUBLE_ARRAY, double_array_value=[1.0, 2.5])
    )

    def get_task(request: Any, response: Any) -> Any:
        if request.task_id == 4:
            response.task = task
        else:
            response.error_code, response.error_msg = "TASK_MISSING", "there is no such task"
        return response

    def events(request: Any, response: Any) -> Any:
        response.events = [Event(run_id=request.run_id, number=request.after + 1, kind="goal", values=[value])]
        return response

    ros.offer(ListTasks, "/tms/db/list_tasks", lambda _, r: ListTasks.Response(tasks=[task]))
    ros.offer(GetTask, "/tms/db/get_task", get_task)
    ros.offer(ListRuns, "/tms/db/list_runs", lambda q, r: ListRuns.Response(runs=[Run(run_id="r")] * q.limit))
    ros.offer(ListEvents, "/tms/db/list_events", events)
    records = [Record(model_name="zx200", record_name="pose", type="static", values=[value])]
    ros.offer(ListParameters, "/tms/db/list_parameters", lambda _, r: ListParameters.Response(records=records))
    past = [PastValues(stamp=Time(sec=5), source="sensing", values=[value])]
    ros.offer(ListParameterHistory, "/tms/db/list_parameter_history",
              lambda q, r: ListParameterHistory.Response(changes=past * q.limit))  # fmt: skip
    assert console.get("/api/tasks")[0]["description"] == "掘削"
    assert console.get("/api/tasks/4")["xml"] == "<root/>"
    assert refusal(console.ask("/api/tasks/5")) == (404, "TASK_MISSING", "there is no such task")
    assert [run["ended_at"] for run in console.get("/api/runs?limit=3")] == [None] * 3
    event = console.get("/api/runs/r-1/events?after=6")[0]
    assert (event["number"], event["values"]) == (7, {"angle": [1.0, 2.5]})
    assert console.get("/api/parameters")[0]["values"] == {"angle": [1.0, 2.5]}
    change = {"stamp": "1970-01-01T00:00:05Z", "source": "sensing", "values": {"angle": [1.0, 2.5]}}
    assert console.get("/api/parameters/history?model_name=zx200&record_name=pose&limit=2") == [change] * 2


def test_commands(console: Console, ros: Ros) -> None:
    cancelled: list[str] = []

    def execute(goal: Goal) -> Ended:
        if goal.request.task_id == 9:
            refused = ExecuteTask.Result(outcome="refused", error_code="MACHINE_BUSY", error_msg="zx200 is in run r-1")
            return Outcome.ABORTED, refused
        goal.publish(ExecuteTask.Feedback(run_id="r-1", state="running"))
        goal.cancelled.wait(LIMIT)
        return Outcome.CANCELED, ExecuteTask.Result(run_id="r-1", outcome="cancelled")

    def cancel(request: Any, response: Any) -> Any:
        cancelled.append(request.run_id)
        return response

    ros.serve(ExecuteTask, "/tms/execute_task", execute)
    ros.offer(CancelRun, "/tms/cancel_run", cancel)
    assert console.ask("/api/runs", {"task_id": 4}) == (202, {"run_id": "r-1"})
    assert refusal(console.ask("/api/runs", {"task_id": 9})) == (409, "MACHINE_BUSY", "zx200 is in run r-1")
    assert console.ask("/api/runs/r-1/cancel", {}) == (202, {"run_id": "r-1"})
    assert cancelled == ["r-1"]
    status, answer = console.ask("/api/runs", {"task_id": 4}, Origin="http://evil.example")
    assert (status, answer["code"]) == (403, "FOREIGN_ORIGIN")


def test_modules_away(console: Console) -> None:
    status, answer = console.ask("/api/tasks")
    assert (status, answer["code"]) == (503, "NO_SERVER")
    assert "/tms/db/list_tasks" in json.dumps(answer)


def test_sigterm_ends_it_while_consoles_look(console: Console) -> None:
    address = ("127.0.0.1", console.site.file.ports.console)
    with socket.create_connection(address, LIMIT) as reader, socket.create_connection(address, LIMIT) as stuck:
        for each in (reader, stuck):
            each.sendall(f"GET /api/events HTTP/1.1\r\nHost: 127.0.0.1:{address[1]}\r\n\r\n".encode())
        text = b""
        while b"event: state" not in text:
            text += reader.recv(65536)
        console.process.terminate()
        assert console.process.wait(LIMIT) == 0, console.log.read_text()
    assert "Traceback" not in console.log.read_text()


def test_port_taken_is_one_line(site: Site, tmp_path: Path) -> None:
    log = tmp_path / "log.txt"
    with socket.create_server(("127.0.0.1", site.file.ports.console)):
        process = spawn(site, log)
        try:
            assert process.wait(LIMIT) == 1
        finally:
            process.kill()
            process.wait(10)
    lines = [line for line in log.read_text().splitlines() if line]
    assert len(lines) == 1, lines
    assert f"port {site.file.ports.console}" in lines[0]
    assert "ports.console" in lines[0]
