"""When the host agent stops a machine in place of its gateway, and how."""

from tms_decision.duty import AGAIN, ESCALATE, HANDED_ON, LEASE_MARGIN, NOTED, Act, Duty, GatewayStatus, Press

THERE = GatewayStatus(alive=True)
SILENT = GatewayStatus(alive=False)
BUSY = GatewayStatus(alive=False, busy=True)
BEAT = 0.05  # s


def acts(duty: Duty, begin: float, seconds: float, seen: GatewayStatus) -> list[tuple[float, Act]]:
    """What is commanded meanwhile, and how long after `begin`."""
    found = []
    for i in range(round(seconds / BEAT)):
        act = duty.check(begin + i * BEAT, seen)
        if act is not None:
            found.append((round(i * BEAT, 3), act))
    return found


def lost(seen: GatewayStatus, seconds: float = 2.0) -> list[tuple[float, Act]]:
    duty = Duty()
    assert acts(duty, 0.0, 1.0, THERE) == []
    return acts(duty, 1.0, seconds, seen)


def test_a_gateway_that_was_never_there_is_not_stood_in_for() -> None:
    assert acts(Duty(), 0.0, 5.0, BUSY) == []


def test_a_short_silence_is_no_loss() -> None:
    duty = Duty()
    duty.check(0.0, THERE)
    for at in (1.0, 2.0):
        assert duty.check(at, BUSY) is None
        assert duty.check(at + LEASE_MARGIN - 0.01, BUSY) is None
        assert duty.check(at + LEASE_MARGIN, THERE) is None
    assert duty.lost_since is None


def test_an_idle_machine_is_cancelled_again_and_again_without_emg_stop() -> None:
    assert lost(SILENT, 1.8) == [(0.1, Act.STOP), (0.6, Act.STOP), (1.1, Act.STOP), (1.6, Act.STOP)]


def test_a_machine_with_a_goal_gets_emg_stop_after_a_second() -> None:
    found = lost(BUSY, 1.7)
    assert found == [(0.1, Act.STOP), (0.6, Act.STOP), (0.1 + ESCALATE, Act.EMERGENCY), (1.6, Act.EMERGENCY)]


def test_a_run_that_is_lost_too_gets_emg_stop_at_once() -> None:
    assert lost(GatewayStatus(alive=False, run_lost=True), 0.5) == [(0.1, Act.EMERGENCY)]


def test_the_loss_of_the_run_does_not_wait_for_the_next_repetition() -> None:
    duty = Duty()
    duty.check(0.0, THERE)
    assert acts(duty, 1.0, 0.2, BUSY) == [(0.1, Act.STOP)]
    assert acts(duty, 1.2, 0.2, GatewayStatus(alive=False, run_lost=True)) == [(0.0, Act.EMERGENCY)]
    again = acts(duty, 1.4, AGAIN, SILENT)  # an emergency stays one
    assert again == [(0.3, Act.EMERGENCY)]


def test_it_goes_on_until_a_gateway_gives_its_pulse_and_has_told_its_state() -> None:
    duty = Duty()
    duty.check(0.0, THERE)
    assert acts(duty, 1.0, 0.2, SILENT)
    assert acts(duty, 2.0, 0.6, THERE) == [(0.0, Act.STOP), (0.5, Act.STOP)]
    assert acts(duty, 3.0, 1.0, GatewayStatus(alive=True, reported=True)) == []
    assert duty.lost_since is None
    assert acts(duty, 5.0, 0.2, SILENT) == [(0.1, Act.STOP)]  # and watches that one


def test_what_it_has_told_before_its_pulse_is_remembered() -> None:
    duty = Duty()
    duty.check(0.0, THERE)
    acts(duty, 1.0, 0.2, SILENT)
    duty.check(1.2, GatewayStatus(alive=False, reported=True))
    duty.check(1.3, THERE)
    assert duty.lost_since is None


def test_a_gateway_that_takes_leave_is_no_loss() -> None:
    duty = Duty()
    duty.check(0.0, THERE)
    assert acts(duty, 1.0, 3.0, GatewayStatus(alive=False, left=True, busy=True)) == [(0.0, Act.STOP)]
    assert duty.lost_since is None


def test_a_stale_writer_that_discovery_drops_later_is_no_leave() -> None:
    duty = Duty()
    duty.check(0.0, THERE)
    acts(duty, 1.0, 0.2, SILENT)
    assert acts(duty, 6.0, 0.4, GatewayStatus(alive=False, left=True)) == [(0.0, Act.STOP)]
    assert duty.lost_since is not None


def test_a_press_is_handed_on_to_a_gateway_that_does_not_show_a_latch() -> None:
    press = Press()
    assert not press.due(10.0, alive=True, latched=False)
    press.since = 10.0
    assert not press.due(10.0 + HANDED_ON - 0.01, alive=True, latched=False)  # it may have heard the button itself
    assert not press.due(20.0, alive=False, latched=False)
    assert press.due(21.0, alive=True, latched=False)
    assert not press.due(21.1, alive=True, latched=False)
    assert press.due(21.0 + HANDED_ON, alive=True, latched=False)
    assert not press.due(30.0, alive=True, latched=True)
    assert not press.due(40.0, alive=True, latched=False)  # re-armed


def test_a_latch_that_is_shown_at_once_may_not_be_on_the_disk_yet() -> None:
    press = Press()
    press.since = 10.0
    assert not press.due(10.1, alive=True, latched=True)
    assert not press.due(11.0 + HANDED_ON, alive=False, latched=None)  # killed before the disk had it
    assert press.due(12.0 + HANDED_ON, alive=True, latched=False)  # its successor is armed
    assert not press.due(20.0, alive=True, latched=True)
    assert not press.due(20.1, alive=True, latched=None)  # it says nothing new
    assert not press.due(13.0 + HANDED_ON + NOTED, alive=True, latched=True)  # by now the disk must have it
    assert press.since is None


def test_a_press_is_over_when_its_gateway_is_re_armed() -> None:
    press = Press()
    press.since = 10.0
    assert not press.due(10.1, alive=True, latched=True)
    assert not press.due(10.2, alive=True, latched=False)
    assert press.since is None
    press.since = 20.0
    assert press.due(20.0 + HANDED_ON, alive=True, latched=False)  # a new press, which it has not heard
