"""The gateway's decisions where two things meet."""

from dataclasses import replace
from typing import Any

import pytest

from simulation.plant import JOINT
from tms_decision.gateway import effects as f
from tms_decision.gateway import events as e
from tms_decision.gateway.active import SERVER_LIMIT
from tms_decision.latch import UNKNOWN_RUN
from tms_decision.owner import Owner
from tms_decision.reasons import (
    CausePersists,
    DrivenByHand,
    GatewayRestartedUnproven,
    GatewayStopped,
    HeldByRun,
    MachineLatched,
    Nameless,
    NoNote,
    NotBelieved,
    NotReady,
    NotSeen,
    NotStill,
    NotTaken,
    SoftwareStopBy,
    SoftwareStopSaying,
    StillActive,
    StillProven,
    StopUnderWay,
    TakenByAnother,
    WhileMoving,
)
from tms_proof.reasons import Frozen
from tms_proof.standstill import JOINTS, ODOM
from tms_reason.reason import Foreign
from unit.tms_decision.gateway_rig import GOAL, RUN, Rig, latched, ready, rearming


def refused(rig: Rig) -> Any:
    """Why the first step of a re-arm is refused."""
    rig.happens(e.RearmAsked(1, "", "t0ken"))
    rig.run(4.0)
    return rig.all(f.Rearmed)[-1].wrong


# a goal that has not left yet


def test_a_machine_that_tells_nothing_is_waited_for_and_then_told() -> None:
    rig = ready()
    rig.plant.fault.mute = True
    rig.run(1.5).ask(1)
    assert not rig.run(SERVER_LIMIT - 0.5).all(f.End)
    rig.run(1.0)
    assert rig.end.outcome == "ABORTED" and isinstance(rig.end.why, NotReady) and not rig.all(f.Send)


def test_a_goal_that_was_asked_for_before_the_machine_was_heard_is_followed_from_where_it_is() -> None:
    rig = Rig()
    rig.ask(1)
    assert not rig.gateway.watch.positions
    rig.run(3.0)
    follower = rig.gateway.active and rig.gateway.active.follower
    assert rig.all(f.Send) and follower is not None and follower.should_have_moved(1.0)


def test_a_machine_that_is_not_believed_gets_no_goal() -> None:
    rig = ready()
    rig.plant.fault.frozen_stamp = True
    rig.run(0.5).ask(1)  # later it would be silent, too
    rig.run(0.2)
    assert isinstance(rig.end.why, NotReady) and not rig.all(f.Send)


def test_a_cancel_while_the_note_is_written_keeps_the_goal() -> None:
    rig = ready()
    rig.disk_answers = False
    rig.ask(1)
    rig.run(0.2)
    note = rig.all(f.KeepState)[-1].number
    rig.gateway.active.cancelled = True  # type: ignore[union-attr]
    rig.disk_answers = True
    rig.happens(e.NoteKept(note))
    rig.run(2.0)
    assert not rig.all(f.Send) and rig.end.outcome == "CANCELED"


@pytest.mark.parametrize("lost", [True, False], ids=["its subtask is lost", "its run is over"])
def test_what_has_ended_between_two_beats_keeps_the_goal(lost: bool) -> None:
    """The goal waits for the machine's messages; then it is looked at because a receipt was kept."""
    rig = ready()
    rig.permits()
    rig.plant.fault.mute = True
    rig.run(1.2).ask(1, GOAL)
    rig.run(0.2)
    links, rig.plant.fault.mute = rig.gateway.links, False
    sample = rig.plant.tell(rig.now)
    assert sample is not None
    rig.happens(e.Sampled(JOINTS, sample))
    if lost:
        links["swing"].asserts, links["swing"].received = False, float("-inf")
    else:
        links["ts"].goal = Owner(8).goal_id(b"abc")
    rig.happens(e.ReceiptKept(99))
    assert not rig.all(f.Send) and len(rig.gateway.stops) == 1
    assert (rig.gateway.latch.hold is not None) == lost


def test_a_latch_while_the_note_is_written_keeps_the_goal() -> None:
    rig = ready()
    rig.disk_answers = False
    rig.ask(1)
    rig.run(0.2)
    note = rig.all(f.KeepState)[-1].number
    rig.gateway.latch.close(Foreign("rain"))  # seen at the last look
    rig.disk_answers = True
    rig.happens(e.NoteKept(note))
    rig.run(2.0)
    assert not rig.all(f.Send) and rig.end.why is not None and rig.end.why.find(MachineLatched) is not None


def test_the_acceptance_of_another_goal_changes_nothing() -> None:
    rig = ready()
    rig.server_answers = False
    rig.ask(1)
    rig.run(0.3)
    rig.happens(e.CallAccepted(2))
    assert rig.gateway.active is not None and rig.gateway.active.begun == 0.0


def test_a_cancel_of_one_goal_leaves_the_other() -> None:
    rig = ready().moving()
    rig.happens(e.GoalCancelled(7))
    assert not rig.gateway.stops
    rig.happens(e.GoalCancelled(1))
    rig.happens(e.GoalCancelled(1))  # again
    assert len(rig.gateway.stops) == 1


# a goal of one joint, of which only the end is known


@pytest.mark.parametrize("joint", [JOINT, "unknown"])
def test_a_turn_is_watched_if_its_joint_is_known(joint: str) -> None:
    rig = ready()
    rig.ask(1, motion=e.Turn(joint, 2.0, 0.5, 1.0))
    rig.run(0.5)
    assert rig.gateway.active is not None
    assert (rig.gateway.active.follower is not None) == (joint == JOINT)
    rig.happens(e.StopAsked(1, None, True))
    rig.run(2.0)
    assert rig.receipt.confirmed


def test_a_goal_without_a_motion_that_is_known_is_stopped_and_seen_to_stand() -> None:
    rig = ready()
    rig.ask(1, motion=None)
    rig.run(1.0)
    rig.happens(e.GoalCancelled(1))
    rig.run(2.0)
    assert rig.end.outcome == "CANCELED"


# while it moves


def test_a_new_clock_while_a_run_moves_it_holds_the_machine() -> None:
    rig = ready()
    rig.permits()
    rig.moving(1, GOAL)
    tell = rig.plant.tell
    rig.plant.tell = lambda now, clock=1e9: tell(now, clock - 100.0)  # type: ignore[method-assign]
    rig.run(0.5)
    assert isinstance(rig.gateway.latch.hold, WhileMoving) and rig.gateway.latch.cause is None


def test_joint_states_that_do_not_change_while_a_goal_should_change_them_latch() -> None:
    rig = ready()
    rig.plant.at_once = True
    rig.moving(1, seconds=20.0)
    tell, angle = rig.plant.tell, rig.plant.angle

    def same(now: float, clock: float = 1e9) -> Any:
        sample = tell(now, clock)
        return None if sample is None else replace(sample, places={JOINT: (angle,)}, speeds={JOINT: 0.5})

    rig.plant.tell = same  # type: ignore[method-assign]
    rig.gateway.active.follower.check = lambda now, angles: None  # type: ignore[union-attr,method-assign]
    rig.gateway.watch.sources[JOINTS].trouble = lambda now: None  # type: ignore[method-assign]
    rig.run(4.0)
    assert isinstance(rig.gateway.latch.cause, Frozen)


def test_a_machine_that_tells_no_joints_is_not_taken_for_frozen() -> None:
    rig = ready().moving()
    sources = rig.gateway.watch.sources
    sources[ODOM] = sources.pop(JOINTS)
    rig.happens(e.Beat(rig.now + 1e9))
    assert rig.gateway.active is not None and rig.gateway.active.stop is None


# re-arm


def test_a_machine_with_a_goal_is_not_armed() -> None:
    rig = ready().moving()
    rig.gateway.latch.close(Foreign("rain"))
    assert refused(rig) == StillActive("zx200")


def test_a_machine_that_is_driven_by_hand_is_not_armed() -> None:
    rig = latched()
    rig.gateway.by_hand = Foreign("Sato")
    assert refused(rig) == DrivenByHand(Foreign("Sato"), "zx200")


def test_a_silent_machine_is_not_armed() -> None:
    rig = latched()
    rig.plant.fault.mute = True
    rig.run(2.0)
    wrong = refused(rig)
    assert isinstance(wrong, CausePersists) and isinstance(wrong.why, NotSeen)


def test_a_machine_that_is_not_believed_is_not_armed() -> None:
    rig = latched()
    rig.happens(e.Published(JOINTS, ("driver", "stranger")))
    rig.happens(e.RearmAsked(1, "", "t0ken"))
    wrong = rig.all(f.Rearmed)[-1].wrong
    assert isinstance(wrong, CausePersists) and isinstance(wrong.why, NotBelieved)


def test_a_machine_whose_stop_is_not_proven_is_not_armed() -> None:
    rig = latched()
    rig.plant.fault.coast = 30.0
    rig.plant.turn(0.2, rig.now, 30.0)
    rig.happens(e.StopAsked(1, None, True))
    assert refused(rig) == CausePersists(StillProven("zx200"))


def test_a_hold_that_the_disk_does_not_know_is_ended_at_once() -> None:
    rig = ready().moving(seconds=2.0)
    rig.run(3.0)
    rig.gateway.latch.keep(Foreign("rain"), Owner(UNKNOWN_RUN))
    assert rig.rearm().armed and rig.gateway.latch.hold is None


def test_a_machine_that_shakes_is_not_armed() -> None:
    rig = latched()
    rig.plant.turn(0.2, rig.now, 0.15)
    rig.run(0.2)
    rig.happens(e.RearmAsked(1, "", "t0ken"))
    assert rig.all(f.Rearmed)[-1].wrong == CausePersists(NotStill("zx200"))


def test_two_re_arms_wait_for_their_own_notes() -> None:
    rig, _ = rearming()
    rig.happens(e.RearmAsked(3, "", "other"))
    note = rig.all(f.KeepState)[-1].number
    rig.happens(e.NoteKept(note - 1))
    assert rig.gateway.latch.cause is not None
    rig.happens(e.NoteKept(note))
    assert rig.gateway.latch.cause is None


# by hand


@pytest.mark.parametrize("who", ["", "  ", "Sa\nto"])
def test_who_takes_the_machine_must_say_a_name(who: str) -> None:
    rig = ready()
    rig.happens(e.TakeAsked(1, who, False))
    assert rig.all(f.Taken) == [f.Taken(1, Nameless())]


def test_a_machine_that_is_taken_or_held_by_a_run_is_not_taken() -> None:
    rig = ready()
    rig.happens(e.TakeAsked(1, "Sato", False))
    rig.happens(e.TakeAsked(2, "Ito", False))
    assert rig.all(f.Taken)[-1] == f.Taken(2, DrivenByHand(Foreign("Sato"), "zx200"))
    other = ready()
    other.permits()
    other.happens(e.TakeAsked(1, "Sato", False))
    assert other.all(f.Taken)[-1] == f.Taken(1, HeldByRun("run-1", "zx200"))


def test_a_goal_that_began_while_the_note_was_written_keeps_the_person_away() -> None:
    rig = ready()
    rig.disk_answers = False
    rig.happens(e.TakeAsked(1, "Sato", False))
    note = rig.all(f.KeepDriver)[-1].number
    rig.disk_answers = True
    rig.moving()
    rig.happens(e.NoteKept(note))
    assert rig.all(f.Taken)[-1] == f.Taken(1, StillActive("zx200")) and rig.all(f.KeepDriver)[-1].who == ""


def test_a_driver_that_the_disk_does_not_take_does_not_drive() -> None:
    rig = ready()
    rig.disk_problem = Foreign("full")
    rig.happens(e.TakeAsked(1, "Sato", False))
    assert rig.all(f.Taken)[-1].wrong is not None and rig.gateway.by_hand is None


def test_a_machine_that_nobody_has_taken_is_not_given_back() -> None:
    rig = ready()
    rig.happens(e.TakeAsked(1, "Sato", True))
    assert rig.all(f.Taken) == [f.Taken(1, NotTaken("zx200"))]


def test_levers_that_are_switched_on_twice_stop_once() -> None:
    rig = ready()
    rig.happens(e.Manual(True))
    rig.happens(e.Manual(True))
    assert len(rig.gateway.stops) == 1
    rig.happens(e.Manual(False))
    rig.happens(e.Manual(False))
    assert rig.gateway.by_hand is None


# stops


def test_a_press_of_a_latched_machine_is_its_own() -> None:
    rig = latched()
    rig.happens(e.Pressed())
    assert not rig.gateway.doubts


@pytest.mark.parametrize("cause", [Foreign("rain"), SoftwareStopBy("Sato")])
def test_a_stop_by_a_request_is_a_software_stop(cause: Foreign) -> None:
    rig = ready()
    rig.happens(e.StopAsked(1, cause, False))
    expected = SoftwareStopSaying(cause) if isinstance(cause, Foreign) else cause
    assert rig.gateway.latch.cause == expected


def test_a_press_of_the_host_agent_is_released_when_the_machine_stands() -> None:
    rig = ready()
    rig.happens(e.StoodIn())
    rig.happens(e.StopAsked(1, None, True))
    rig.run(2.0)
    assert f.Emergency(False) in rig.done and not rig.gateway.stood_in


def test_a_press_of_the_host_agent_is_not_released_before_the_machine_would_hear_it() -> None:
    rig = Rig(e.Left(None, "run-1", 7))
    rig.look = replace(rig.look, reachable=False)
    rig.permits(RUN, None)
    rig.happens(e.StoodIn())
    rig.happens(e.StopAsked(1, None, True))
    rig.run(4.5)
    assert rig.receipt.confirmed and f.Emergency(False) not in rig.done
    rig.look = replace(rig.look, reachable=True)
    rig.run(0.2)
    rig.happens(e.StopAsked(2, None, True))
    rig.run(6.0)
    assert f.Emergency(False) in rig.done


def test_a_goal_that_an_ending_gateway_has_stopped_is_told_so() -> None:
    rig = ready().moving()
    rig.happens(e.Leaving())
    rig.happens(e.GoalCancelled(1))
    rig.run(2.0)
    assert rig.end.outcome == "CANCELED"
    assert rig.end.why is not None and rig.end.why.find(GatewayStopped) is not None


# the start


def test_a_latch_whose_receipt_was_lost_is_proven_again() -> None:
    rig = Rig(e.Left(Foreign("rain"), unproven=True))
    rig.run(12.0)
    cause = rig.receipt.cause
    assert cause.find(GatewayRestartedUnproven) is not None and rig.receipt.confirmed


def test_servers_that_are_not_there_are_not_waited_for_for_ever() -> None:
    rig = Rig()
    rig.look = replace(rig.look, reachable=False)
    rig.run(2.0)
    assert not rig.gateway.recovery.reached
    rig.run(10.0)
    assert rig.gateway.recovery.reached


def test_another_run_that_takes_a_machine_left_moving_latches_it() -> None:
    rig = Rig(e.Left(None, "run-6", 6))
    rig.run(0.2)
    rig.permits(RUN, None)
    assert rig.gateway.latch.cause is not None and rig.gateway.latch.cause.find(TakenByAnother) is not None
    rig.run(9.0)
    assert rig.receipt.run == 6  # that is the run whose motion was ended


def test_a_start_that_is_claimed_twice_stops_once() -> None:
    rig = Rig(e.Left(None, "run-1", 7))
    rig.run(0.2)
    rig.permits(RUN, None)
    stops = len(rig.gateway.stops)
    rig.permits(RUN, None)
    assert len(rig.gateway.stops) == stops == 1


def test_a_goal_that_has_waited_for_too_long_is_refused() -> None:
    rig = ready()
    rig.look = replace(rig.look, settling=True)
    rig.ask(1)
    rig.run(6.0)
    rig.plant.fault.coast = 30.0
    rig.plant.turn(0.2, rig.now, 30.0)
    rig.happens(e.StopAsked(1, None, True))
    rig.run(4.5)
    assert rig.end.why == NotReady(StopUnderWay())


def test_a_button_that_is_repeated_stops_once() -> None:
    rig = ready()
    for _ in range(3):
        rig.happens(e.Signal(True))
    assert len(rig.gateway.stops) == 1


def test_a_run_that_reports_itself_before_the_servers_are_reached_is_stopped_once() -> None:
    rig = Rig(e.Left(None, "run-1", 7))
    rig.look = replace(rig.look, reachable=False)
    rig.run(0.2)
    rig.permits(RUN, None)
    rig.look = replace(rig.look, reachable=True)
    rig.run(0.2)
    assert rig.gateway.recovery.reached and rig.gateway.numbered == 1


def test_a_stop_is_proven_faster() -> None:
    rig = ready()
    assert not rig.gateway.proves()
    rig.happens(e.StopAsked(1, None, True))
    assert rig.gateway.proves()


def test_a_beat_may_send_a_goal_only_until_it_is_sent() -> None:
    """Other beats need not be on the thread that sends goals."""
    rig = ready()
    assert not rig.gateway.may_send()
    rig.plant.fault.mute = True
    rig.run(1.5).ask(1)
    rig.run(0.2)
    assert rig.gateway.may_send() and not rig.all(f.Send)
    rig.plant.fault.mute = False
    rig.run(1.0)
    assert rig.all(f.Send) and not rig.gateway.may_send()


def test_a_beat_may_send_a_goal_while_a_gateway_starts() -> None:
    rig = Rig()
    rig.look = replace(rig.look, reachable=False)
    rig.run(0.2)
    assert rig.gateway.may_send()


def test_a_machine_that_moves_while_a_receipt_waits_for_the_disk_is_stopped() -> None:
    rig = latched()
    rig.disk_answers = False
    rig.happens(e.StopAsked(9, None, False))
    rig.run(1.5)
    assert rig.all(f.KeepReceipt) and rig.gateway.stops
    rig.done.clear()
    rig.plant.turn(0.3, rig.now, 3.0)
    rig.run(1.0)
    assert rig.all(f.CancelAll)


@pytest.mark.parametrize("at_once", [False, True])
@pytest.mark.parametrize(
    "left", [e.Left(None, "run-1", 7), e.Left(Foreign("rain"), unproven=True), e.Left(NoNote())], ids=str
)
def test_a_press_before_the_first_proof_does_not_believe_a_record_of_the_time_before(
    left: e.Left, at_once: bool
) -> None:
    rig = Rig(left, at_once=at_once)
    rig.look = replace(rig.look, reachable=False)  # its start goes on for some seconds
    rig.happens(e.Signal(True))
    rig.happens(e.Signal(False))
    rig.run(3.0)
    assert not rig.all(f.Tell), "nothing but a standing machine was seen, as in a record that is told again and again"
    rig.run(9.0)
    assert rig.receipt.confirmed
