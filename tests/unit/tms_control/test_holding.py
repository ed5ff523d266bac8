"""What holds joints after a stop, and when an emergency stop is released."""

import pytest

from tms_control.holding import HOLDS, MARGIN, RELEASE_MARGIN, Holding

DEAD = 0.9  # s
BEAT = 0.05  # s


Sent = list[tuple[float, float]]


def run(holding: Holding, begin: float, end: float, speed: float = 0.0, angle: float = 0.0) -> Sent:
    """The held angles of a joint that moves on at `speed`, by time; a release counts as infinite."""
    sent, now = [], begin
    while now < end:
        orders = holding.step(now, {"boom": angle + speed * (now - begin)})
        if orders.release:
            sent.append((now, float("inf")))
        if orders.angles is not None:
            sent.append((now, orders.angles["boom"]))
        now += BEAT
    return sent


def test_without_a_stop_nothing_is_sent() -> None:
    holding = Holding(DEAD, {})
    assert run(holding, 0.0, 5.0) == [] and not holding.busy


def test_joints_are_followed_while_old_commands_play_and_then_held_at_one_place() -> None:
    holding = Holding(DEAD, {})
    holding.stop(0.0)
    sent = run(holding, 0.0, 5.0, speed=0.1)
    moved = [angle for now, angle in sent if now < DEAD + MARGIN]
    assert moved == pytest.approx([0.1 * BEAT * i for i in range(len(moved))])
    assert {angle for now, angle in sent if now >= DEAD + MARGIN} == {moved[-1]}
    assert sent[-1][0] == pytest.approx(DEAD + MARGIN + HOLDS, abs=2 * BEAT) and not holding.busy


def test_a_stop_that_is_repeated_does_not_follow_a_joint_that_sags() -> None:
    holding = Holding(0.0, {})
    holding.stop(0.0)
    first = run(holding, 0.0, 0.5, speed=-0.05)
    holding.stop(0.5)
    held = {angle for now, angle in first + run(holding, 0.5, 3.0, angle=-0.025) if now >= MARGIN}
    assert len(held) == 1


def test_after_the_joints_are_held_a_new_stop_holds_them_anew() -> None:
    holding = Holding(0.0, {})
    holding.stop(0.0)
    run(holding, 0.0, 3.0)
    holding.stop(10.0)
    assert run(holding, 10.0, 10.1, angle=0.7)[0] == (10.0, 0.7)


def test_a_joint_that_hangs_is_commanded_higher() -> None:
    holding = Holding(0.0, {"boom": -0.1})
    holding.stop(0.0)
    assert run(holding, 0.0, 0.04, angle=0.5) == [(0.0, pytest.approx(0.4))]


def test_a_release_waits_until_nothing_is_left_of_what_was_sent_before_the_stop() -> None:
    holding = Holding(DEAD, {})
    holding.stop(0.0)
    holding.press()
    run(holding, 0.0, 0.3)
    holding.release(0.3)
    sent = run(holding, 0.3, 5.0, angle=0.2)
    released = [now for now, angle in sent if angle == float("inf")]
    assert released == [pytest.approx(DEAD + RELEASE_MARGIN, abs=BEAT)]
    after = [angle for now, angle in sent if now >= released[0] and angle != float("inf")]
    assert len(after) >= 5 and set(after) == {0.2} and not holding.busy


def test_long_after_a_stop_a_release_is_at_once_and_holds_the_joints() -> None:
    holding = Holding(DEAD, {})
    holding.stop(0.0)
    run(holding, 0.0, 60.0)
    holding.release(60.0)
    assert holding.busy
    sent = run(holding, 60.0, 62.0, angle=0.4)
    assert sent[0] == (60.0, float("inf")) and {angle for _, angle in sent[1:]} == {0.4}


def test_a_machine_that_is_not_heard_is_not_brought_back_to_where_it_was() -> None:
    holding = Holding(DEAD, {})
    holding.stop(0.0)
    run(holding, 0.0, 0.5, angle=0.1)
    assert holding.step(0.5, {}).angles is None
    assert holding.step(0.6, {"boom": 0.4}).angles == {"boom": 0.4}


def test_a_press_takes_a_release_back() -> None:
    holding = Holding(DEAD, {})
    holding.stop(0.0)
    holding.release(0.0)
    holding.press()
    assert float("inf") not in {angle for _, angle in run(holding, 0.0, 10.0)}
