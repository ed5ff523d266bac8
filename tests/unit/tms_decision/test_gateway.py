"""The gateway's decisions, with a machine that obeys: goals, stops, losses, re-arm, memory."""

from dataclasses import replace

import pytest

from tms_decision.gateway import effects as f
from tms_decision.gateway import events as e
from tms_decision.gateway import motion
from tms_decision.gateway.presses import STANDBY
from tms_decision.owner import Owner
from tms_decision.reasons import (
    BadToken,
    Cancelled,
    CancelledElsewhere,
    CausePersists,
    ControllerAway,
    ControllerEnded,
    ControllerLeft,
    DrivenByHand,
    GatewayRestartedHeld,
    GatewayStood,
    HeldByAnother,
    LeftStandStill,
    MachineLatched,
    ManualMode,
    NoEnd,
    NoGoalAnswer,
    NoPermit,
    NoScheduler,
    NoSubtask,
    NotKept,
    NotReady,
    NotSeenToStand,
    NotStopped,
    PressedByOthers,
    ProcessesLost,
    ProcessLost,
    SchedulerLost,
    SoftwareStop,
    StillActive,
    StillMoved,
    StillPressed,
    StopUnconfirmed,
    StopUnderWay,
    TooLong,
    WhileMoving,
)
from tms_proof.reasons import Old
from tms_reason.reason import Foreign, Reason
from unit.tms_decision.gateway_rig import GOAL, LEAF, RUN, SERVER, Rig, latched, ready, rearming

FULL: Reason = Foreign("the disk is full")


# goals


def test_a_foreign_goal_moves_the_machine_and_succeeds() -> None:
    rig = ready().moving(seconds=2.0)
    assert rig.gateway.notes.asked == (None, "a foreign client", 0)
    rig.run(3.0)
    assert rig.end == f.End(1, "SUCCEEDED")
    assert rig.gateway.notes.asked == (None, "", 0)


def test_a_goal_of_a_run_needs_all_processes_behind_it() -> None:
    rig = ready()
    rig.ask(1, GOAL)
    rig.run(2.9)
    assert not rig.all(f.End)
    rig.run(0.2)
    assert rig.end == f.End(1, "ABORTED", NoPermit(NoScheduler()))
    rig.permits(subtask=None)
    rig.ask(2, GOAL)
    rig.run(3.1)
    assert rig.end == f.End(2, "ABORTED", NoPermit(NoSubtask()))
    rig.permits()
    rig.ask(3, GOAL)
    assert rig.all(f.Send) == [f.Send(3)]


def test_a_permit_that_comes_a_moment_later_is_waited_for() -> None:
    rig = ready()
    rig.ask(1, GOAL)
    rig.run(1.0).permits()
    assert rig.run(0.2).all(f.Send) == [f.Send(1)]


def test_one_goal_at_a_time() -> None:
    rig = ready().moving()
    rig.ask(2)
    assert rig.end == f.End(2, "ABORTED", StillMoved("zx200"))


def test_a_goal_beyond_the_limits_is_refused() -> None:
    rig = ready()
    rig.ask(1, wrong=Foreign("beyond"))
    assert rig.end == f.End(1, "ABORTED", Foreign("beyond")) and not rig.gateway.waiting


def test_a_run_keeps_foreign_goals_away() -> None:
    rig = ready()
    rig.permits()
    rig.ask(1)
    assert rig.end == f.End(1, "ABORTED", NoPermit(HeldByAnother()))


def test_a_goal_leaves_only_after_its_note_is_on_the_disk() -> None:
    rig = ready()
    rig.disk_answers = False
    rig.ask(1)
    rig.run(1.0)
    assert not rig.all(f.Send)
    rig.disk_answers = True
    rig.happens(e.NoteKept(rig.all(f.KeepState)[-1].number))
    assert rig.run(0.1).all(f.Send) == [f.Send(1)]


def test_a_goal_that_the_disk_does_not_take_is_refused() -> None:
    rig = ready()
    rig.disk_problem = FULL
    rig.ask(1)
    assert rig.end == f.End(1, "ABORTED", FULL) and rig.gateway.active is None
    rig.disk_problem = None
    rig.moving(2)


def test_a_goal_waits_for_the_commands_of_a_stop_before_it() -> None:
    rig = ready()
    rig.look = replace(rig.look, settling=True)
    rig.run(0.1).ask(1)
    assert not rig.run(0.5).all(f.Send)
    rig.look = replace(rig.look, settling=False)
    assert rig.run(0.2).all(f.Send) == [f.Send(1)]


def test_a_goal_that_waits_while_its_run_ends_never_leaves() -> None:
    rig = ready()
    rig.permits()
    rig.happens(e.StopAsked(9, Foreign("the end of a run"), True))
    rig.ask(1, GOAL)
    rig.run(3.0)
    assert rig.receipt.confirmed and not rig.all(f.Send)
    assert (rig.end.number, rig.end.outcome) == (1, "CANCELED")


def test_a_foreign_goal_waits_for_the_end_of_a_run_and_leaves() -> None:
    rig = ready()
    rig.happens(e.StopAsked(9, Foreign("the end of a run"), True))
    rig.ask(1)
    rig.run(3.0)
    assert [one.number for one in rig.all(f.Send)] == [1]


def test_a_goal_waits_until_the_host_agent_no_longer_commands_the_machine() -> None:
    rig = ready()
    rig.happens(e.StandsIn(True))
    rig.run(0.1).ask(1)
    assert not rig.run(STANDBY - 0.5).all(f.Send)
    rig.happens(e.StandsIn(True))  # it repeats it
    assert not rig.run(STANDBY - 0.5).all(f.Send)
    rig.happens(e.StandsIn(False))
    assert rig.run(0.2).all(f.Send) == [f.Send(1)]


def test_a_host_agent_that_falls_silent_keeps_no_goal_for_long() -> None:
    rig = ready()
    rig.happens(e.StandsIn(True))
    rig.ask(1)
    assert not rig.run(STANDBY - 0.2).all(f.Send)
    assert rig.run(0.4).all(f.Send) == [f.Send(1)]


def test_a_server_that_is_away_is_waited_for_and_then_told() -> None:
    rig = ready()
    rig.look = replace(rig.look, ready=False)
    rig.run(0.1).ask(1)
    assert not rig.run(2.0).all(f.End)
    rig.run(1.2)
    assert rig.end == f.End(1, "ABORTED", ControllerAway("zx200", SERVER))


def test_a_machine_that_tells_nothing_gets_no_goal() -> None:
    rig = ready()
    rig.plant.fault.mute = True
    rig.run(1.5).ask(1)
    rig.run(3.5)
    assert rig.end.outcome == "ABORTED" and isinstance(rig.end.why, NotReady) and not rig.all(f.Send)


def test_a_server_that_does_not_answer_is_stopped_and_given_up() -> None:
    rig = ready()
    rig.server_answers = False
    rig.ask(1)
    rig.run(motion.ACCEPT_LIMIT + 0.3)
    assert rig.all(f.GiveUp) == [f.GiveUp(1)] and rig.all(f.Cancel) == [f.Cancel(1)]
    rig.happens(e.CallEnded(1, "LOST"))
    rig.run(8.0)
    assert rig.receipt.cause == ProcessLost(NoGoalAnswer("zx200", SERVER))


def test_a_server_that_leaves_during_a_goal_stops_the_machine_and_ends_the_goal() -> None:
    rig = ready().moving()
    rig.look = replace(rig.look, gone=True)
    rig.run(0.1)
    assert rig.all(f.Lose) == [f.Lose(1)]
    rig.happens(e.CallEnded(1, "LOST"))
    rig.run(2.0)
    assert rig.receipt.cause == ProcessLost(ControllerLeft("zx200", SERVER)) and rig.receipt.confirmed


def test_the_machine_s_own_refusal_is_told() -> None:
    rig = ready()
    rig.plant.emergency = True  # it is still pressed at the machine
    rig.ask(1)
    rig.run(0.2)
    assert rig.end == f.End(1, "ABORTED", ControllerEnded("zx200", "REJECTED"))


def test_a_cancel_by_somebody_else_is_a_loss() -> None:
    rig = ready().moving()
    rig.happens(e.CallEnded(1, "CANCELED"))
    assert rig.end == f.End(1, "ABORTED", ProcessLost(CancelledElsewhere()))


# stops


def test_a_cancel_is_told_when_the_machine_was_seen_to_stand() -> None:
    rig = ready().moving()
    rig.happens(e.GoalCancelled(1))
    rig.run(0.3)
    assert not rig.all(f.End)
    rig.run(1.5)
    assert rig.end.outcome == "CANCELED" and rig.receipt.confirmed and rig.receipt.cause == Cancelled()
    assert not rig.plant.moves() and rig.gateway.latch.cause is None


@pytest.mark.parametrize("waits", ["for its note", "for the server"])
def test_a_cancel_before_the_goal_leaves_does_not_wait_for_what_it_waits_for(waits: str) -> None:
    rig = ready()
    rig.look = replace(rig.look, ready=waits != "for the server")
    rig.run(0.1).disk_answers = waits != "for its note"
    rig.ask(1)
    rig.happens(e.GoalCancelled(1))
    rig.run(1.0).disk_answers = True
    for kept in rig.all(f.KeepReceipt) if waits == "for its note" else []:
        rig.happens(e.ReceiptKept(kept.stop))
    assert rig.end.outcome == "CANCELED" and rig.receipt.cause == Cancelled() and not rig.all(f.Send)


def test_a_software_stop_ends_the_goal_and_latches() -> None:
    rig = ready().moving()
    rig.happens(e.Signal(True))
    kinds = [type(one) for one in rig.done]
    assert kinds.index(f.Zero) < kinds.index(f.Emergency) < kinds.index(f.CancelAll)
    rig.run(2.0)
    assert rig.end.outcome == "ABORTED" and (rig.receipt.confirmed, rig.receipt.latched) == (True, True)
    assert rig.gateway.notes.asked == (SoftwareStop(), "", 0)
    rig.happens(e.Signal(False))
    rig.ask(2)
    assert rig.end == f.End(2, "ABORTED", MachineLatched("zx200", SoftwareStop()))


def test_the_receipt_is_on_the_disk_before_it_is_told() -> None:
    rig = ready().moving()
    rig.disk_answers = False
    rig.happens(e.StopAsked(5, None, True))
    rig.run(2.0)
    kept = rig.all(f.KeepReceipt)
    assert kept and not rig.all(f.Tell) and not rig.all(f.Stopped)
    rig.happens(e.ReceiptKept(kept[0].stop, "No space left on device"))
    assert rig.all(f.Stopped)[0].request == 5 and rig.receipt.confirmed and rig.receipt.evidence is not None


def test_a_disk_that_never_answers_ends_the_wait_for_a_receipt_without_a_proof() -> None:
    rig = ready().moving()
    rig.disk_answers = False
    rig.happens(e.StopAsked(5, None, True))
    rig.run(12.0)
    assert not rig.all(f.Stopped)[0].receipt.confirmed and not rig.all(f.Tell)
    assert rig.end.outcome == "ABORTED" and isinstance(rig.end.why, StopUnconfirmed)
    rig.happens(e.ReceiptKept(rig.all(f.KeepReceipt)[0].stop))
    assert rig.receipt.confirmed and len(rig.all(f.Stopped)) == 1 and not rig.gateway.stops


def test_a_machine_that_ignores_the_stop_is_commanded_again_and_latched() -> None:
    rig = ready().moving(seconds=60.0)
    rig.plant.fault.ignore_cancel = rig.plant.fault.ignore_emergency = True
    rig.happens(e.StopAsked(5, None, True))
    rig.run(10.5)
    assert len(rig.all(f.CancelAll)) > 10 and not rig.receipt.confirmed
    assert isinstance(rig.gateway.latch.cause, NotSeenToStand) and rig.all(f.Emergency)[-1] == f.Emergency(True)


def test_a_machine_that_leaves_stand_still_is_stopped_and_latched() -> None:
    rig = ready().moving(seconds=1.0)
    rig.happens(e.StopAsked(5, None, True))
    rig.run(3.0)
    rig.plant.coming.append((rig.now, 0.2))
    rig.run(1.0)
    assert rig.gateway.latch.cause == LeftStandStill() and rig.plant.emergency
    rig.run(2.0)
    assert not rig.receipt.confirmed and rig.receipt.detail == LeftStandStill()


def test_it_is_watched_while_the_disk_stalls() -> None:
    """The goal that was stopped waits for its receipt."""
    rig = ready().moving(seconds=20.0)
    rig.disk_answers = False
    rig.happens(e.StopAsked(5, None, True))
    rig.run(3.0)
    assert rig.all(f.KeepReceipt) and rig.gateway.active is not None
    rig.plant.emergency = False  # levers
    rig.plant.coming.append((rig.now, 0.2))
    rig.run(1.0)
    assert rig.gateway.latch.cause == LeftStandStill() and rig.plant.emergency


def test_an_answer_without_the_disk_proves_nothing_and_latches() -> None:
    """The caller is told that the machine is latched, so it is."""
    rig = ready().moving(seconds=20.0)
    rig.disk_answers = False
    rig.happens(e.StopAsked(5, None, True))
    rig.run(10.9)
    assert not rig.all(f.Stopped) and rig.gateway.latch.cause is None
    rig.run(0.5)
    answer = rig.all(f.Stopped)[-1].receipt
    assert (answer.confirmed, answer.latched, answer.detail) == (False, True, NoEnd())
    assert isinstance(rig.gateway.latch.cause, NotSeenToStand) and rig.plant.emergency
    assert rig.all(f.KeepState)[-1].latched == rig.gateway.latch.cause


def test_a_motion_that_lasts_too_long_is_stopped() -> None:
    rig = ready()
    rig.ask(1, None, 20.0, lasts=2.0)
    rig.run(motion.OVERRUN + 4.0)
    assert rig.receipt.cause == TooLong() and rig.receipt.confirmed and not rig.plant.moves()


def test_a_machine_that_falls_silent_while_it_moves_is_stopped_and_latched() -> None:
    rig = ready()
    rig.ask(1, motion=None)  # with a reference, joints that stand still are found even sooner
    rig.run(1.0).plant.fault.mute = True
    rig.run(1.0)
    assert isinstance(rig.gateway.latch.cause, WhileMoving)
    assert not rig.receipt.confirmed and isinstance(rig.receipt.detail, Old), "nothing shows that it stands"
    assert not rig.all(f.End), "its goal ends when it was seen to stand"
    rig.plant.fault.mute = False
    rig.run(4.0)
    assert not rig.receipt.confirmed, "it is elsewhere than before it fell silent, as if it replayed a record"
    rig.run(1.0)
    assert rig.receipt.confirmed and rig.receipt.latched and rig.receipt.cause == rig.gateway.latch.cause
    assert len(rig.all(f.Tell)) == 2 and rig.end.outcome == "ABORTED"


def test_a_joint_beyond_its_limits_is_stopped_and_latched() -> None:
    rig = ready().moving()
    rig.look = replace(rig.look, escaped=Foreign("boom has left its limits"))
    rig.run(0.1)
    assert rig.gateway.latch.cause == Foreign("boom has left its limits")


def test_a_goal_of_which_nobody_sees_whether_it_has_is_stopped_and_held() -> None:
    rig = ready()
    rig.permits()
    rig.moving(1, GOAL)
    rig.look = replace(rig.look, escaped=ProcessLost(Foreign("its place is not told")))
    rig.run(0.1)
    assert rig.gateway.latch.cause is None and rig.gateway.latch.hold is not None


def test_a_gateway_that_stood_still_stops_its_machine() -> None:
    rig = ready()
    rig.permits()
    rig.moving(1, GOAL)
    rig.now += 0.7
    rig.run(0.1)
    stop = rig.gateway.stops[0].cause.find(GatewayStood)
    assert stop is not None and rig.gateway.latch.hold is not None


# losses


def test_a_lost_subtask_holds_the_machine_for_its_run() -> None:
    rig = ready()
    rig.permits()
    rig.moving(1, GOAL)
    rig.lose("swing")
    assert rig.gateway.latch.hold == ProcessLost(ProcessesLost(("zx200:swing",)))
    rig.run(2.0)
    assert rig.end.outcome == "ABORTED" and rig.receipt.confirmed and not rig.receipt.latched
    rig.permits(subtask=Owner(7, 2, 0))
    rig.moving(2, Owner(7, 2, 1))
    assert rig.gateway.latch.hold is None


def test_a_lost_scheduler_latches() -> None:
    rig = ready()
    rig.permits()
    rig.moving(1, GOAL)
    rig.lose("ts")
    assert rig.gateway.latch.cause == SchedulerLost()
    rig.run(2.0)
    assert rig.receipt.run == RUN.run and rig.receipt.confirmed


def test_an_orderly_end_of_a_run_is_no_loss() -> None:
    rig = ready()
    rig.permits()
    rig.permits(None, None)
    assert rig.gateway.latch.cause is None and rig.gateway.run is None


def test_a_loss_before_the_goal_leaves_keeps_it() -> None:
    rig = ready()
    rig.permits()
    rig.look = replace(rig.look, ready=False)
    rig.run(0.1).ask(1, GOAL)
    rig.lose("swing")
    rig.look = replace(rig.look, ready=True)
    rig.run(2.0)
    assert not rig.all(f.Send) and rig.end.outcome == "ABORTED" and rig.gateway.latch.hold is not None


def test_a_late_pc_is_given_a_moment_more() -> None:
    rig = ready()
    rig.permits()
    rig.moving(1, GOAL)
    rig.happens(e.PermitReported("swing", 0, 1, True))
    assert not rig.gateway.stops
    rig.happens(e.PermitReported("swing", 1, 0, False))
    rig.run(0.2)
    assert not rig.gateway.stops
    rig.happens(e.PermitReported("swing", 0, 1, True))
    rig.run(0.2)
    assert rig.gateway.stops


# people


def test_a_re_arm_takes_two_steps_and_releases_the_machine() -> None:
    rig = ready().moving()
    rig.happens(e.Signal(True))
    rig.happens(e.Signal(False))
    rig.run(2.0)
    answer = rig.rearm()
    assert answer.armed and answer.wrong is None and not rig.plant.emergency
    assert rig.gateway.notes.asked == (None, "", 0)
    rig.moving(2)


def test_the_jump_of_a_release_is_not_taken_for_a_motion_that_the_last_gateway_has_left() -> None:
    rig = Rig(e.Left(SoftwareStop()), jumps=2.5).run(0.5)
    assert rig.rearm().armed and rig.gateway.recovery.until > rig.now
    rig.plant.accept(99, 0.3, 0.5, rig.now)
    rig.run(8.0)
    assert rig.gateway.watch.moved_at > 100.0 and rig.gateway.latch.cause is None
    rig.moving(2)


def test_a_re_arm_counts_only_when_its_note_is_on_the_disk() -> None:
    rig = latched()
    rig.disk_problem = FULL
    answer = rig.rearm()
    assert answer.wrong == NotKept(FULL) and not answer.armed and rig.gateway.latch.cause == SoftwareStop()


def test_a_stop_while_the_note_of_a_re_arm_is_written_keeps_the_machine_latched() -> None:
    rig, note = rearming()
    rig.happens(e.Signal(True))
    rig.happens(e.NoteKept(note.number))
    answer = rig.all(f.Rearmed)[-1]
    assert not answer.armed and isinstance(answer.wrong, BadToken)
    assert rig.all(f.KeepState)[-1].latched == SoftwareStop()


def test_a_stop_of_a_run_that_ends_does_not_undo_the_note_of_a_re_arm() -> None:
    rig, note = rearming()
    rig.happens(e.StopAsked(3, Foreign("the end of a run"), True))
    rig.run(1.0)
    assert rig.all(f.KeepReceipt)[-1].receipt.confirmed
    rig.happens(e.NoteKept(note.number))
    assert rig.all(f.Rearmed)[-1].armed and rig.all(f.KeepState)[-1] == note and note.latched is None


@pytest.mark.parametrize("token", ["", "wrong"])
def test_an_armed_machine_needs_no_re_arm(token: str) -> None:
    rig = ready()
    rig.happens(e.RearmAsked(1, token, "t0ken"))
    assert rig.all(f.Rearmed) == [f.Rearmed(1, None, "", True, NotStopped("zx200"))]


def test_a_pressed_button_keeps_from_arming() -> None:
    rig = ready()
    rig.happens(e.Signal(True))
    rig.run(2.0)
    rig.happens(e.Signal(True))
    rig.happens(e.RearmAsked(1, "", "t0ken"))
    assert not rig.all(f.Rearmed)  # the stop is being proven
    rig.run(0.9)
    assert rig.all(f.Rearmed)[0].wrong == CausePersists(StillPressed())


def test_a_person_takes_the_machine_and_gives_it_back() -> None:
    rig = ready()
    rig.happens(e.TakeAsked(1, "Sato", False))
    assert rig.all(f.Taken) == [f.Taken(1)] and rig.all(f.KeepDriver)[-1].who == "Sato"
    rig.ask(1)
    assert rig.end == f.End(1, "ABORTED", DrivenByHand(Foreign("Sato"), "zx200"))
    rig.plant.coming.append((rig.now, 0.2))
    rig.run(1.0)
    assert rig.gateway.latch.cause is None  # nobody opposes the person
    rig.plant.coming.append((rig.now, 0.0))
    rig.happens(e.TakeAsked(2, "Sato", True))
    rig.run(2.0)
    assert rig.all(f.Stopped)[-1].receipt.confirmed and rig.gateway.by_hand is None
    assert rig.all(f.KeepDriver)[-1].who == ""


@pytest.mark.parametrize(("stalls", "mute", "waits"), [(3.0, True, 7.1), (12.0, False, 4.1)])
def test_who_gives_it_back_waits_for_the_disk_and_for_the_proof_together(
    stalls: float, mute: bool, waits: float
) -> None:
    rig = ready()
    rig.happens(e.TakeAsked(1, "Sato", False))
    rig.disk_answers = False
    rig.happens(e.TakeAsked(2, "Sato", True))
    rig.run(stalls)
    rig.plant.fault.mute, rig.disk_answers = mute, True
    rig.happens(e.NoteKept(rig.all(f.KeepDriver)[-1].number))
    assert not rig.all(f.Stopped)
    rig.run(waits)
    assert rig.all(f.Stopped)[-1].receipt.confirmed is not mute


def test_a_machine_with_a_goal_is_not_taken() -> None:
    rig = ready().moving()
    rig.happens(e.TakeAsked(1, "Sato", False))
    assert rig.all(f.Taken) == [f.Taken(1, StillActive("zx200"))]


@pytest.mark.parametrize("jumps", [0.0, 2.5])
def test_what_the_host_agent_has_pressed_is_released_before_the_receipt_that_waits_for_a_jump(jumps: float) -> None:
    rig = ready(jumps=jumps).moving()
    rig.happens(e.StoodIn())
    rig.happens(e.GoalCancelled(1))
    while f.Emergency(False) not in rig.done:
        assert rig.now < 120.0, "it is never released"
        assert not rig.all(f.Tell)
        rig.run(0.05)
    released = rig.now
    while not rig.all(f.Tell):
        assert rig.now < 120.0, "there is never a receipt"
        rig.run(0.05)
    assert rig.now - released >= jumps
    assert rig.receipt.confirmed and not rig.receipt.latched
    assert rig.done.count(f.Emergency(False)) == 1


def test_a_machine_that_goes_on_after_its_release_is_latched() -> None:
    rig = ready(jumps=2.5).moving()
    rig.happens(e.StoodIn())
    rig.happens(e.GoalCancelled(1))
    while f.Emergency(False) not in rig.done:
        rig.run(0.05)
    rig.plant.accept(99, 60.0, 0.5, rig.now)  # a motion that no cancel ends
    rig.plant.fault.ignore_cancel = True
    rig.run(15.0)
    assert not rig.receipt.confirmed and rig.gateway.latch.cause is not None


def test_its_own_levers_stop_its_goal() -> None:
    rig = ready().moving()
    rig.happens(e.Manual(True))
    rig.run(2.0)
    assert rig.end.outcome == "ABORTED" and rig.gateway.by_hand == ManualMode()
    rig.happens(e.Manual(False))
    assert rig.gateway.by_hand is None and len(rig.gateway.stops) == 1


def test_a_press_of_a_stranger_latches_and_one_of_the_host_agent_does_not() -> None:
    rig = ready()
    rig.run(12.0)  # no new gateway any more
    rig.happens(e.Pressed())
    rig.happens(e.StoodIn())
    rig.run(0.5)
    assert rig.gateway.latch.cause is None
    rig.run(2.0)
    rig.happens(e.Pressed())
    rig.ask(1)
    assert rig.gateway.waiting  # it is not known yet who has pressed
    rig.run(2.0)
    assert rig.gateway.latch.cause == PressedByOthers() and rig.end.outcome == "ABORTED"


# memory


def test_a_gateway_that_a_run_has_held_stops_the_machine_and_holds_it_for_the_run() -> None:
    rig = Rig(e.Left(None, "run-1", 7))
    rig.plant.accept(99, 30.0, 0.5, rig.now)  # the motion that the last gateway has left
    assert isinstance(rig.done[0], f.Zero)
    rig.run(0.1)
    assert rig.gateway.recovering and rig.gateway.latch.hold is not None
    rig.permits(subtask=None)
    rig.run(10.0)
    assert not rig.gateway.recovering and rig.gateway.latch.cause is None
    told = [one.receipt for one in rig.all(f.Tell)]
    assert told[-1].confirmed and told[-1].cause.find(GatewayRestartedHeld) is not None
    rig.permits(subtask=Owner(7, 3, 0))
    rig.moving(1, Owner(7, 3, 1))


def test_a_gateway_that_is_lost_once_more_leaves_the_run_to_its_successor() -> None:
    rig = Rig(e.Left(None, "run-1", 7))
    rig.permits(subtask=None)
    rig.run(10.0)
    assert rig.receipt.confirmed and rig.gateway.notes.asked == (None, "run-1", 7)
    rig.permits(None, None)
    assert rig.gateway.notes.asked == (None, "", 0)


@pytest.mark.parametrize("left", [e.Left(None), e.Left(None, "run-1", 7)], ids=["left idle", "held by the run"])
def test_a_goal_of_a_run_waits_for_the_end_of_a_start(left: e.Left) -> None:
    rig = Rig(left).run(0.5)
    rig.permits(subtask=Owner(7, 3, 0))
    rig.ask(1, Owner(7, 3, 1))
    rig.run(12.0)
    assert rig.all(f.Send) == [f.Send(1)] and rig.end == f.End(1, "SUCCEEDED")


def test_a_run_that_does_not_report_itself_latches() -> None:
    rig = Rig(e.Left(None, "run-1", 7)).run(12.0)
    assert rig.gateway.latch.cause is not None and not rig.gateway.recovering
    assert {one.receipt.run for one in rig.all(f.Tell)} == {7}  # a lost scheduler looks for the receipts of its run


def test_a_moving_machine_without_a_run_is_stopped_and_latched() -> None:
    rig = Rig()
    rig.run(0.5)
    rig.plant.accept(99, 60.0, 0.5, rig.now)
    rig.run(5.0)
    assert rig.gateway.latch.cause is not None
    rig.run(10.0)
    assert not rig.plant.moves() and not rig.gateway.recovering


def test_a_latch_is_remembered() -> None:
    rig = Rig(e.Left(SoftwareStop())).run(3.0)
    assert rig.plant.emergency
    rig.ask(1)
    assert rig.end == f.End(1, "ABORTED", MachineLatched("zx200", SoftwareStop()))


def test_a_goal_does_not_pass_a_stop_that_is_being_proven() -> None:
    rig = ready().moving()
    rig.happens(e.StopAsked(5, None, True))
    rig.ask(2)
    assert rig.run(0.2).gateway.waiting
    rig.run(3.0)
    assert rig.all(f.Send) == [f.Send(1), f.Send(2)] and StopUnderWay.code


def test_what_stands_behind_a_leaf_is_only_that_leaf() -> None:
    rig = ready()
    rig.permits(subtask=LEAF)
    rig.ask(1, Owner(7, 2, 1))
    rig.run(3.1)
    assert rig.end == f.End(1, "ABORTED", NoPermit(NoSubtask()))


# what others see


def published(rig: Rig, seconds: float) -> int:
    """How often the state is published within that time."""
    before = len(rig.all(f.Publish))
    rig.run(seconds)
    return len(rig.all(f.Publish)) - before


def test_a_machine_that_stands_is_told_of_now_and_then_and_one_that_moves_often() -> None:
    rig = ready()
    assert published(rig, 5.0) in (9, 10)
    rig.moving(seconds=20.0)
    assert published(rig, 5.0) in (20, 25)


def test_a_change_is_told_at_once() -> None:
    rig = ready()
    rig.happens(e.PermitHeard("ts", RUN.goal_id(b"abc"), "run-1"))
    assert published(rig, 0.05) == 1


def test_a_damaged_number_of_a_stop_changes_nothing() -> None:
    rig = ready()
    rig.happens(e.ReceiptKept(17))
    assert rig.done == []


def test_a_machine_that_goes_on_after_the_end_of_its_goal_is_not_believed_to_stand() -> None:
    """Its server has ended the goal, and it replays a record of standing while it coasts."""
    rig = ready()
    rig.plant.fault.replay = True
    rig.plant.told = [(0.0, 0.0, 0.0)] * 20
    rig.ask(1)
    rig.run(1.0)
    assert rig.plant.speed > 0.0
    rig.happens(e.CallEnded(1, "ABORTED"))
    rig.happens(e.StopAsked(1, None, True))
    rig.run(rig.gateway.watch.dead_time + 0.5)
    assert not rig.all(f.Tell)
