"""A simulator that is lost, paused or started again while our controller moves its machine."""

import os
import signal
from collections.abc import Iterator
from typing import Any

import pytest
from tms_msg_rc.msg import MachineState, StopReceipt

from mc_rig import angles, armed, begin, ended, moving, send
from operasim_rig import OperaSim, operasim
from tms_ros.goals import Outcome

pytestmark = [
    pytest.mark.turns,
    pytest.mark.ros,
    pytest.mark.filterwarnings("ignore:module 'sre_:DeprecationWarning"),  # a parser that the ROS wheels bring
]
MACHINE = "zx200_9"  # a name of its own: other tests may have machines in the same domain


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory, domain: int, first_port: int) -> Iterator[OperaSim]:
    with operasim(tmp_path_factory.mktemp("mc_losses"), domain, first_port + 64, MACHINE, "zx200") as made:
        begin(made)
        yield made


def swinging(site: OperaSim) -> tuple[Any, list[MachineState], list[StopReceipt]]:
    """A goal that moves the swing for long, and what the gateway tells from now on."""
    armed(site)
    states: list[MachineState] = site.hear(MachineState, "rc/state")
    receipts: list[StopReceipt] = site.hear(StopReceipt, "rc/receipts")
    now = angles(site)["swing_joint"]
    _, call = send(site, {"swing_joint": -2.0 if now > 0.0 else 2.0}, 15)
    moving(site, "swing_joint")
    return call, states, receipts


def test_a_lost_connection_latches_and_stops_before_anything_else(site: OperaSim) -> None:
    call, states, receipts = swinging(site)
    site.command("cut 3")
    assert ended(site, call) is Outcome.ABORTED
    site.until(lambda: states[-1].latch, "it is latched")
    site.until(lambda: receipts, "what is known at once")
    assert not receipts[0].confirmed and receipts[0].latched
    assert receipts[0].seconds == 0.0, "it is told without waiting for the simulator"
    back = site.log.index("time=2", site.log.index("reason=cut"))
    heard = site.log[back:].split("event=hears")[0]
    assert "emg_stop" in heard, "its stop comes before anything else"
    site.until(lambda: len(receipts) > 1, "the second receipt, of what was seen when it was back")
    assert receipts[-1].latched
    site.until(site.stands, "it stands")


def test_a_paused_simulator_is_stopped_and_goes_on_after_a_rearm(site: OperaSim) -> None:
    call, states, _ = swinging(site)
    site.command("pause")
    assert ended(site, call) is Outcome.ABORTED
    site.until(lambda: states[-1].latch, "it is latched")
    site.command("resume")
    site.until(site.stands, "it stands")
    armed(site)


def test_a_simulator_that_is_started_again_is_not_moved_on(site: OperaSim) -> None:
    call, _, _ = swinging(site)
    site.command("restart 2")
    assert ended(site, call) is Outcome.ABORTED
    site.until(lambda: site.command("state")["time"] > 3.0 and site.stands(), "it stands after its new start")
    armed(site)
    _, call = send(site, {"swing_joint": 0.3})
    assert ended(site, call) is Outcome.SUCCEEDED, call.result


def test_a_controller_that_did_not_run_moves_nothing_when_it_goes_on(site: OperaSim) -> None:
    """It was stopped meanwhile: where its trajectory would be by now is far from where the machine is held."""
    call, _, _ = swinging(site)
    controller = site.process(f"{MACHINE}:mc")
    os.kill(controller.pid, signal.SIGSTOP)
    site.until(site.stands, "it was stopped")
    held = site.joint("swing_joint")["target"]
    os.kill(controller.pid, signal.SIGCONT)
    ended(site, call)
    begun, away = site.command("state")["time"], 0.0
    while site.command("state")["time"] < begun + 2.0:  # a last command would come after its dead time
        away = max(away, abs(site.joint("swing_joint")["target"] - held))
    assert away < 0.03
