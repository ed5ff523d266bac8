"""The stand-in of OperaSim-PhysX as it runs, in a thread, steered by its control port; and its program."""

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from conftest import PROJECT, wait_until
from fake_endpoint import FakeEndpoint, endpoint_frame, handshake
from operasim import model
from operasim.cdr import Writer
from operasim.model import Unknowns
from operasim.program import main
from operasim.simulator import Settings, Simulator
from tms_cli.drill.operasim import ControlPort

LIMIT = 20.0  # s
STOP = b"\0\1\0\0\1"


class Rig:
    """A simulator that runs, its endpoint and a client of its control port."""

    def __init__(self) -> None:
        self.endpoint = FakeEndpoint()
        self.events: list[tuple[str, dict[str, Any]]] = []
        settings = Settings(model.scene("SimpleScene"), Unknowns(), self.endpoint.address, control=0)
        self.simulator = Simulator(settings, self._event)
        self._thread = threading.Thread(target=self.simulator.run, daemon=True)
        self._thread.start()
        self._control = ControlPort(self.told("control")[0]["port"], LIMIT)
        self.command = self._control.command

    def until(self, holds: Callable[[], bool], what: str) -> None:
        def done() -> bool:
            self.endpoint.look()
            return holds()

        wait_until(done, LIMIT, lambda: f"{what}; {self.events}", every=0.002)

    def connected(self, times: int = 1) -> None:
        self.until(lambda: self.endpoint.connections == times and self.endpoint.client is not None, "a connection")
        self.endpoint.say(handshake())
        self.until(lambda: len(self.told("handshake")) == times, "a handshake")

    def odom(self) -> int:
        return len(self.endpoint.messages("zx200/odom"))

    def told(self, name: str) -> list[dict[str, Any]]:
        return [fields for one, fields in list(self.events) if one == name]

    def close(self) -> None:
        self.simulator.end()
        self._thread.join(LIMIT)
        assert not self._thread.is_alive()
        self._control.close()
        self.endpoint.close()

    def _event(self, name: str, **fields: Any) -> None:
        self.events.append((name, fields))


@pytest.fixture
def rig() -> Iterator[Rig]:
    made = Rig()
    made.connected()
    yield made
    made.close()


def test_it_tells_and_hears(rig: Rig) -> None:
    rig.until(lambda: rig.odom() > 10, "odometry")
    rig.endpoint.say(endpoint_frame("ic120/vessel/cmd", Writer().put("d", -0.5).message))
    rig.endpoint.say(endpoint_frame("zx200/emg_stop", STOP))
    rig.until(lambda: bool(rig.told("emg_stop")), "a stop")
    machines = rig.command("state")["machines"]
    assert machines["zx200"]["stopped"]
    assert machines["ic120"]["joints"]["vessel_pin_joint"]["target"] == -0.5
    assert {fields["topic"] for fields in rig.told("hears")} == {"ic120/vessel/cmd", "zx200/emg_stop"}


def test_single_joints_are_registered_late(rig: Rig) -> None:
    rig.until(lambda: ("__subscribe", "zx200/bucket/cmd") in rig.endpoint.commands(), "the last registration")
    commands = rig.endpoint.commands()
    assert commands.index(("__subscribe", "zx200/track_cmd")) < commands.index(("__subscribe", "zx200/swing/cmd"))


def test_a_pause_keeps_the_connection(rig: Rig) -> None:
    rig.until(lambda: rig.odom() > 10, "odometry")
    before = rig.command("pause")["time"]
    rig.endpoint.look()
    alive = rig.endpoint.keep_alives()
    rig.until(lambda: rig.endpoint.keep_alives() > alive, "a keep-alive")
    rig.endpoint.say(endpoint_frame("zx200/emg_stop", STOP))
    state = rig.command("state")
    assert (state["paused"], state["connected"], state["time"]) == (True, True, before)
    told = rig.odom()
    rig.command("resume")
    rig.until(lambda: bool(rig.told("emg_stop")), "what came meanwhile")
    rig.until(lambda: rig.odom() > told, "odometry")
    assert rig.told("resumed") == rig.told("paused")


def test_time_stands_still_and_goes_on(rig: Rig) -> None:
    rig.until(lambda: rig.odom() > 10, "odometry")
    rig.command("speed 0")
    rig.until(lambda: rig.command("state")["time"] == rig.command("state")["time"], "a standing time")
    stands = rig.command("state")["time"]
    rig.endpoint.say(endpoint_frame("zx200/emg_stop", STOP))
    rig.until(lambda: bool(rig.told("emg_stop")), "frames that go on")
    assert rig.command("state")["time"] == stands
    assert rig.command("speed 5")["speed"] == 5.0
    rig.until(lambda: rig.command("state")["time"] > stands + 1.0, "time goes on")


def test_a_cut_connection_is_made_again_and_all_registered(rig: Rig) -> None:
    rig.until(lambda: ("__subscribe", "zx200/bucket/cmd") in rig.endpoint.commands(), "the last registration")
    before = rig.command("cut 0.1")
    rig.until(lambda: rig.endpoint.client is None, "the cut")
    rig.endpoint.frames.clear()
    rig.connected(times=2)
    rig.until(lambda: ("__topic_list", "") in rig.endpoint.commands(), "the registrations")
    assert ("__subscribe", "zx200/bucket/cmd") in rig.endpoint.commands()
    assert rig.endpoint.commands().count(("__publish", "zx200/odom")) == 1
    assert rig.command("state")["time"] > before["time"]


def test_a_restart_begins_anew(rig: Rig) -> None:
    rig.endpoint.say(endpoint_frame("zx200/emg_stop", STOP))
    rig.until(lambda: bool(rig.told("emg_stop")), "a stop")
    rig.until(lambda: rig.command("state")["time"] > 0.5, "some time")
    assert rig.command("restart 0.1")["time"] == 0.0
    rig.until(lambda: rig.endpoint.client is None, "the end")
    rig.endpoint.frames.clear()
    rig.connected(times=2)
    state = rig.command("state")
    assert not state["machines"]["zx200"]["stopped"]
    rig.until(lambda: ("__topic_list", "") in rig.endpoint.commands(), "the registrations")
    assert rig.endpoint.commands().count(("__publish", "zx200/odom")) == 2


@pytest.mark.parametrize("line", ["", "dance", "speed fast", "speed -1", "speed nan", "cut 1 2"])
def test_what_is_no_command_is_refused(rig: Rig, line: str) -> None:
    assert "error" in rig.command(line)
    assert rig.command("state")["connected"]


def test_a_program_that_ends_when_told(tmp_path_factory: pytest.TempPathFactory) -> None:
    endpoint = FakeEndpoint()
    log = tmp_path_factory.mktemp("operasim") / "log"
    words = [sys.executable, "-m", "operasim", "--scene", "SampleScene", "--port", str(endpoint.address[1])]
    env = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    with (
        log.open("w") as out,
        subprocess.Popen(words, cwd=PROJECT / "tests", env=env, stdout=out, stderr=out) as program,
    ):

        def odometry() -> bool:
            endpoint.look()
            return bool(endpoint.messages("mst110cr/odom_pose"))

        wait_until(odometry, LIMIT, log.read_text)
        program.send_signal(signal.SIGTERM)
        assert program.wait(LIMIT) == 0
    endpoint.close()
    events = [line.split("event=")[1].split()[0] for line in log.read_text().splitlines()]
    assert events == ["started", "connected", "disconnected", "ended"]


def test_options_that_cannot_be(tmp_path_factory: pytest.TempPathFactory) -> None:
    for words in (["--scene", "Nowhere"], ["--yaw-gain", "0"], ["--speed", "-1"]):
        result = CliRunner().invoke(main, words)
        assert result.exit_code == 2
        assert words[0].removeprefix("--").replace("-", "_") in result.output or words[1] in result.output


def test_it_needs_nothing_of_services() -> None:
    """A stand-in that shared code with the bridge would hide what both get wrong."""
    files = [*Path(model.__file__).parent.glob("*.py")]
    assert len(files) > 10
    for file in files:
        assert "tms_" not in file.read_text(), file
