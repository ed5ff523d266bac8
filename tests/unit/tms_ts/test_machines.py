"""What counts as a loss of a process, and what is only a server that has not found us yet."""

import time
from types import SimpleNamespace
from typing import Any

import pytest
from tms_msg_rc.msg import StopReceipt

from tms_reason.reason import Reason
from tms_ros.client import Call
from tms_ros.goals import Outcome
from tms_ros.reasons import NoAnswer
from tms_ts.gateways import Gateways
from tms_ts.machines import ASK_AGAIN, Identity, Machines
from tms_ts.reasons import LostTimes, ProcessEnded, ProcessState, SentAgainSoon
from tms_ts.replay import Replay
from tms_ts.sent_goal import ACCEPT_LIMIT, RECOVERY, SentGoal
from tms_ts.world import GoalState
from words import words

RETRIES = 2


class Peer:
    """A server that is there and takes its time."""

    def __init__(self) -> None:
        self.calls: list[Call] = []
        self.cancelled: list[Call] = []

    def cancel(self, call: Call) -> None:
        self.cancelled.append(call)

    def ready(self) -> bool:
        return True

    def send(self, request: Any, *, goal_id: bytes, on_change: Any) -> Call:
        self.calls.append(Call(goal_id, on_change, None))
        return self.calls[-1]


class Site:
    """One machine whose subtask has process 1, a clock that is set by hand, and stops that are told at once."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.now, self.pid, self.peer = 0.0, 1, Peer()
        self.reported: list[str] = []
        self.kept: list[tuple[Any, ...]] = []  # what the record has of ends
        self.fatal: Reason | None = None
        self.trouble: Reason | None = None
        monkeypatch.setattr(time, "monotonic", lambda: self.now)
        monkeypatch.setattr(Machines, "_stop_after_loss", lambda one, machine, cause: one._stopping.discard(machine))
        self.peer.mark_lost = lambda: None  # type: ignore[attr-defined]
        ros = SimpleNamespace(peer=lambda *_: self.peer)
        hosts = SimpleNamespace(pid=lambda *_: self.pid, trouble=lambda *_: self.trouble, fatal=lambda *_: self.fatal)
        gateways = SimpleNamespace(obstacle=lambda _: None, latch=lambda _: None)
        self.replay = Replay([(("0.1", "zx200", "dig", "here"), True)])
        record = SimpleNamespace(
            sent=lambda _: None,
            done=lambda key, succeeded: self.kept.append(("done", key, succeeded)),
            gone=lambda key, left: self.kept.append(("gone", key, left)),
        )
        self.machines = Machines(
            ros,  # type: ignore[arg-type]
            hosts,  # type: ignore[arg-type]
            gateways,  # type: ignore[arg-type]
            lambda: None,
            lambda kind, _, what: self.reported.append(f"{kind}: {words(what)}"),
            Identity(1, RETRIES, record, self.replay),  # type: ignore[arg-type]
        )
        self.goal: SentGoal = self.machines.send("zx200", "subtask_zx200_change_pose", "pose", "0")

    def retry(self, seconds: float, outcome: Outcome | None = None) -> None:
        """What a RetryUntilSuccessful around a leaf does, at 20 ticks a second; its goals may all end at once."""
        for _ in range(round(seconds * 20)):
            for call in self.peer.calls if outcome is not None else []:
                call.end(outcome)
            if self.goal.state.final:
                self.goal = self.send_again()
            self.pass_time(0.05)

    def send_again(self) -> SentGoal:
        return self.machines.send("zx200", "subtask_zx200_change_pose", "pose", "0")

    def pass_time(self, seconds: float) -> None:
        self.now += seconds
        self.machines.advance()

    def lose(self) -> None:
        """The subtask's process ends and is back under another number."""
        self.pid += 1
        self.pass_time(0.1)
        self.pass_time(RETRIES)  # the goal is sent again


@pytest.fixture
def site(monkeypatch: pytest.MonkeyPatch) -> Site:
    return Site(monkeypatch)


def test_a_server_that_never_answers_is_a_loss(site: Site) -> None:
    for losses in range(1, RETRIES + 1):
        site.pass_time(RECOVERY + ACCEPT_LIMIT)
        assert site.goal.losses == losses
        site.pass_time(RETRIES)
    assert site.peer.cancelled == site.peer.calls[:RETRIES]  # should they be accepted after all
    site.pass_time(RECOVERY + ACCEPT_LIMIT)
    name = "zx200:subtask_zx200_change_pose"
    assert site.goal.reason == LostTimes(NoAnswer(name, site.goal.action, ACCEPT_LIMIT), RETRIES + 1)
    assert site.goal.state.final


def test_a_server_that_does_not_hear_us_soon_after_a_loss_is_asked_again_without_a_further_loss(site: Site) -> None:
    site.lose()
    assert (site.goal.losses, len(site.peer.calls)) == (1, 2)
    site.pass_time(ACCEPT_LIMIT + 0.1)
    site.pass_time(RETRIES)
    assert (site.goal.losses, len(site.peer.calls)) == (1, 3)
    assert not site.goal.state.final


def test_a_process_that_ends_again_is_a_further_loss_however_soon(site: Site) -> None:
    site.lose()
    site.lose()
    assert site.goal.losses == RETRIES
    site.lose()
    assert site.goal.state.final
    assert site.goal.reason is not None and site.goal.reason.find(ProcessEnded) is not None


@pytest.mark.parametrize(("outcome", "again"), [(Outcome.SUCCEEDED, True), (Outcome.CANCELED, False)])
def test_with_a_goal_that_was_really_done_the_past_is_over(site: Site, outcome: Outcome, again: bool) -> None:
    if outcome is Outcome.CANCELED:
        site.goal.cancel()
    site.peer.calls[0].end(outcome)
    after = site.machines.send("zx200", "dig", "here", "0.1")
    assert (len(site.peer.calls) == 2) is again
    assert after.state is (GoalState.SENDING if again else GoalState.SUCCEEDED)


def test_a_receipt_is_told_once(site: Site) -> None:
    receipt = StopReceipt(machine="zx200", confirmed=True, seconds=0.5, cause="x")
    site.machines.stops.receipt(receipt)
    site.machines.stops.receipt(receipt)
    assert [text for text in site.reported if text.startswith("stop")] == ["stop: zx200 stood after 0.50 s, 0.00 m: x"]


def test_a_goal_that_is_cancelled_while_it_waits_to_be_sent_again_is_never_sent(site: Site) -> None:
    site.goal.call, site.goal.state, site.goal.cancelled = None, GoalState.SENDING, True  # between two threads
    site.pass_time(1.0)
    assert site.goal.state is GoalState.CANCELLED
    assert len(site.peer.calls) == 1
    assert site.machines.settled()


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


@pytest.mark.parametrize("outcome", [Outcome.REJECTED, Outcome.ABORTED, Outcome.CANCELED])
def test_a_loop_around_a_goal_that_fails_at_once_floods_nothing(site: Site, outcome: Outcome) -> None:
    site.retry(2.0, outcome)
    assert 3 <= len(site.peer.calls) <= 1 + 2.0 / ASK_AGAIN
    assert len(site.reported) < 20
    assert site.goal.reason == SentAgainSoon()


def test_only_the_goal_that_has_failed_waits(site: Site) -> None:
    site.peer.calls[0].end(Outcome.ABORTED)
    site.machines.send("zx200", "subtask_zx200_change_pose", "other pose", "1")
    assert len(site.peer.calls) == 2
    site.peer.calls[1].end(Outcome.SUCCEEDED)
    site.machines.send("zx200", "subtask_zx200_change_pose", "other pose", "1")
    assert len(site.peer.calls) == 3


def test_a_goal_that_the_tree_has_halted_is_sent_again_at_once(site: Site) -> None:
    site.goal.cancel()
    site.peer.calls[0].end(Outcome.CANCELED)
    site.send_again()
    assert len(site.peer.calls) == 2


def test_a_process_that_is_given_up_is_told_once(site: Site) -> None:
    site.peer.calls[0].end(Outcome.ABORTED)
    site.trouble = site.fatal = ProcessState("zx200:subtask_zx200_change_pose", "FATAL")
    site.retry(10.0)
    assert len([text for text in site.reported if text.startswith("alarm")]) == 1
    assert site.reported.count(f"goal: {words(site.fatal)}") >= 10
    assert len(site.peer.calls) == 1


def test_what_the_tree_did_not_ask_for_again_is_gone_for_a_later_resume_too(site: Site) -> None:
    site.peer.calls[0].end(Outcome.SUCCEEDED)
    past = ("0.1", "zx200", "dig", "here")
    assert site.kept == [("gone", past, 1), ("done", site.goal.key, True)]


def test_the_past_is_over_before_the_tree_can_ask_for_the_next_goal(
    site: Site, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen: list[bool] = []
    monkeypatch.setattr(site.replay, "moved_on", lambda _: seen.append(site.goal.state.final) or [])
    site.peer.calls[0].end(Outcome.SUCCEEDED)
    assert seen == [False]
    assert site.goal.state is GoalState.SUCCEEDED
