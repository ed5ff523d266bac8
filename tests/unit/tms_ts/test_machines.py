"""What the decisions about leaf goals want is done at the subtasks' servers, and what these answer gets to them."""

from types import SimpleNamespace
from typing import Any

import pytest
from tms_msg_rc.msg import StopReceipt
from tms_msg_ts.action import LeafNodeBase

from tms_decision.leaf.events import NO_LOSS, Failure
from tms_decision.leaf.replay import Replay
from tms_decision.leaf.state import GoalState
from tms_decision.owner import Owner, parse
from tms_decision.reasons import NoPermit, NoScheduler, ProcessLost
from tms_machine.reasons import NoDatabase
from tms_reason.reason import Foreign, Reason
from tms_reason.wire import to_line
from tms_ros.client import Call
from tms_ros.goals import Outcome
from tms_ros.reasons import LostMeanwhile
from tms_ts import machines as module
from tms_ts.gateways import Gateways
from tms_ts.machines import LOOK_PERIOD, Identity, Machines, _ended
from words import words

LOST = ProcessLost(LostMeanwhile("zx200:rp", "/zx200/tms_rp_zx200_change_pose"))


class Peer:
    """A server that is there and takes its time."""

    def __init__(self, told: list[str]) -> None:
        self.told, self.calls, self.requests = told, list[Call](), list[Any]()
        self.looks = 0

    def ready(self) -> bool:
        self.looks += 1
        return True

    def send(self, request: Any, *, goal_id: bytes, on_change: Any) -> Call:
        self.told.append("sent")
        self.requests.append(request)
        self.calls.append(Call(goal_id, on_change, None))
        return self.calls[-1]

    def cancel(self, call: Call) -> None:
        self.told.append("cancelled")

    def mark_lost(self) -> None:
        self.told.append("server dead")


class Site:
    """A machine whose subtask has process 1; what was done, in its order."""

    def __init__(self) -> None:
        self.told: list[str] = []
        self.peer, self.pid = Peer(self.told), 1
        hosts = SimpleNamespace(
            pid=lambda *_: self.pid, age=lambda *_: 0.0, trouble=lambda *_: None, fatal=lambda *_: None
        )
        gateways = SimpleNamespace(obstacle=lambda _: None, latch=lambda _: None)
        record = SimpleNamespace(
            sent=lambda key: self.told.append(f"checkpoint: sent {key[3]}"),
            done=lambda key, succeeded: self.told.append(f"checkpoint: done {key[3]} {succeeded}"),
            gone=lambda key, left: self.told.append(f"checkpoint: gone {key[3]} {left}"),
        )
        self.machines = Machines(
            SimpleNamespace(peer=lambda *_: self.peer),  # type: ignore[arg-type]
            SimpleNamespace(other_form=lambda _: ""),  # type: ignore[arg-type]
            hosts,  # type: ignore[arg-type]
            gateways,  # type: ignore[arg-type]
            lambda: None,
            lambda kind, _, what: self.told.append(f"{kind}: {words(what)}"),
            Identity(7, 2, record, Replay([(("0.1", "zx200", "dig", "there"), True)])),  # type: ignore[arg-type]
        )
        self.stopped: list[str] = []
        self.machines._stop_after_loss = lambda machine, cause: self.stopped.append(machine)  # type: ignore[method-assign]
        self.goal = self.machines.send("zx200", "dig", "here", "0.0")


@pytest.fixture
def site() -> Site:
    return Site()


def test_a_goal_is_kept_then_sent_with_the_number_of_its_run(site: Site) -> None:
    assert site.told == ["goal: sent to zx200:dig, record here", "checkpoint: sent here", "sent"]
    assert parse(site.peer.calls[0].id) == Owner(7, 1)
    assert site.peer.requests[0] == LeafNodeBase.Goal(model_name="zx200", record_name="here")


def test_what_is_told_of_a_goal_reaches_the_tree(site: Site) -> None:
    call = site.peer.calls[0]
    assert site.goal.state is GoalState.SENDING
    call.accepted = True
    call.received(SimpleNamespace(feedback=LeafNodeBase.Feedback(status=to_line(Foreign("digs")))))
    assert (site.goal.state, words(site.goal.feedback)) == (GoalState.RUNNING, "digs")
    call.end(Outcome.SUCCEEDED)
    assert site.goal.state is GoalState.SUCCEEDED and site.goal.reason is None and site.goal.feedback is None
    assert site.told[-3:] == ["checkpoint: gone there 1", "checkpoint: done here True", "goal: zx200:dig succeeded"]
    assert site.machines.settled()


def test_a_failure_is_told_with_the_last_feedback(site: Site) -> None:
    call = site.peer.calls[0]
    call.feedback = LeafNodeBase.Feedback(status=to_line(Foreign("it rains")))
    call.end(Outcome.ABORTED)
    assert (site.goal.state, words(site.goal.reason)) == (GoalState.FAILED, "zx200:dig gave up: it rains")


def test_a_cancel_goes_to_the_server_and_the_goal_is_open_until_it_has_ended(site: Site) -> None:
    site.goal.cancel()
    assert site.told[-1] == "cancelled" and site.machines.open_goals() == ["zx200:dig"]
    site.peer.calls[0].end(Outcome.CANCELED)
    assert site.machines.open_goals() == []


def test_a_server_that_has_got_the_goal_is_looked_for_five_times_a_second(
    site: Site, monkeypatch: pytest.MonkeyPatch
) -> None:
    now = module.monotonic()
    monkeypatch.setattr(module, "monotonic", lambda: now)

    def looks(count: int) -> int:
        before = site.peer.looks
        for _ in range(count):
            site.machines.advance()
        return site.peer.looks - before

    now += 1.0
    assert looks(10) == 1
    now += LOOK_PERIOD + 1e-6  # whatever the clock is rounded to
    assert looks(10) == 1
    site.pid = 2  # the goal is lost, and waits to be sent again
    site.machines.advance()
    assert looks(10) == 10


def test_the_sending_to_a_process_that_has_ended_is_lost_once(site: Site) -> None:
    site.pid = 2
    site.machines.advance()
    assert site.told[-2] == "server dead" and site.told[-1].startswith("loss: process zx200:dig ended")
    assert site.peer.calls[0].outcome is Outcome.LOST
    site.machines.advance()
    assert len(site.told) == 5
    assert not site.machines.settled()


@pytest.mark.parametrize(
    ("why", "failure"),
    [
        (Foreign("it rains"), NO_LOSS),
        (NoDatabase("tms:db"), Failure.NO_STORE),
        (NoPermit(NoScheduler()), Failure.UNREACHED),
        (LOST, Failure.LOST),
    ],
)
def test_what_a_failure_says_of_the_processes_below(why: Reason, failure: Failure) -> None:
    call = Call(b"", None, None)
    call.feedback = LeafNodeBase.Feedback(status=to_line(why))
    assert _ended(1, call, Outcome.ABORTED).failure == failure


def test_an_effect_that_fails_does_not_keep_the_next_ones(site: Site, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(_call: Call) -> None:
        raise RuntimeError("a bug")

    monkeypatch.setattr(site.peer, "cancel", broken)
    with pytest.raises(RuntimeError, match="a bug"):
        site.goal.cancel()
    site.peer.calls[0].end(Outcome.SUCCEEDED)
    assert site.goal.state is GoalState.SUCCEEDED


def test_a_receipt_is_told_once(site: Site) -> None:
    receipt = StopReceipt(machine="zx200", confirmed=True, seconds=0.5, cause="x")
    site.machines.stops.receipt(receipt)
    site.machines.stops.receipt(receipt)
    assert [text for text in site.told if text.startswith("stop")] == ["stop: zx200 stood after 0.50 s, 0.00 m: x"]


def test_a_request_is_made_again_when_the_gateway_is_lost_or_comes_back() -> None:
    gateways, gateway = Gateways.__new__(Gateways), SimpleNamespace(alive=True)
    gateways._gateways = {"zx200": gateway}  # type: ignore[dict-item]
    for before in (True, False):  # lost meanwhile; asked of a dead one, whose successor never saw it
        gateway.alive = before
        lost = gateways.loss("zx200")
        assert not lost()
        gateway.alive = not before
        assert lost()
    assert not gateways.loss("zx9")()
