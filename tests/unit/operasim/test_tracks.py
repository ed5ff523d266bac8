"""Tracks and base of the stand-in of OperaSim-PhysX, in virtual time, against the figures known of its prefabs."""

import math

import pytest

from operasim.machine import Machine
from operasim.model import Placed, Unknowns, machine

STEP = 0.02


def made(model: str, height: float = 0.0, **unknowns: float) -> Machine:
    return Machine(machine(model), Placed(model=model, place=(0.0, 0.0, height)), Unknowns(**unknowns))


def run(of: Machine, seconds: float) -> None:
    for _ in range(round(seconds / STEP)):
        of.scripts(0.0)
        of.physics(STEP)


@pytest.mark.parametrize(("model", "lag"), [("zx200", 1.34), ("zx120", 1.0)])
def test_lag_of_the_speed(model: str, lag: float) -> None:
    one = made(model)
    one.tracks.twist(1.0, 0.0)
    run(one, lag)
    assert one.tracks.forward == pytest.approx(0.632, abs=0.02)


@pytest.mark.parametrize(("model", "lag"), [("ic120", 0.54), ("mst110cr", 1.33), ("c30r", 0.14)])
def test_with_an_integral_part_the_speed_comes_sooner_and_overshoots(model: str, lag: float) -> None:
    one = made(model)
    one.tracks.twist(1.0, 0.0)
    run(one, lag)
    assert 0.63 < one.tracks.forward < 0.9
    fastest = 0.0
    for _ in range(500):
        run(one, STEP)
        fastest = max(fastest, one.tracks.forward)
    assert fastest > 1.02


def test_a_slow_command_brakes_at_once() -> None:
    one = made("zx200")
    one.tracks.twist(1.0, 0.0)
    run(one, 10.0)
    assert one.tracks.forward == pytest.approx(1.0, abs=0.01)
    one.tracks.twist(0.0009, 0.0)
    run(one, 2 * STEP)
    assert one.tracks.forward == 0.0


def test_the_last_command_holds_for_ever() -> None:
    one = made("ic120")
    one.tracks.twist(0.5, 0.0)
    run(one, 60.0)
    assert one.tracks.forward == pytest.approx(0.5, abs=0.01)
    assert one.base.x > 28.0


def test_limits_of_a_twist_and_none_of_track_cmd() -> None:
    one = made("c30r")
    one.tracks.twist(9.0, -9.0)
    assert (one.tracks.left.command, one.tracks.right.command) == (3 + 0.615 * 3, 3 - 0.615 * 3)
    one.track_cmd({"left_track": 7.0})
    assert (one.tracks.left.command, one.tracks.right.command) == (7.0, 3 - 0.615 * 3)
    one.track_cmd({"forward_volume": 9.0, "turn_volume": 0.0})
    assert (one.tracks.left.command, one.tracks.right.command) == (3.0, 3.0)
    one.track_cmd({"forward_volume": 1.0})
    assert one.tracks.left.command == 3.0


@pytest.mark.parametrize("gain", [1 / 3, 0.6, 1.0])
def test_true_yaw_and_that_of_the_odometry(gain: float) -> None:
    one = made("zx200", yaw_gain=gain)
    one.tracks.twist(0.0, 0.4)
    run(one, 10.0)
    before, told = one.base.yaw, one.tracks.odometry[2]
    run(one, 10.0)
    assert (one.base.yaw - before) / 10 == pytest.approx(0.4 * gain, rel=0.01)
    assert (one.tracks.odometry[2] - told) / 10 == pytest.approx(0.4 / 3, rel=0.01)


def test_the_odometry_of_c30r_tells_half_of_the_yaw_rate() -> None:
    one = made("c30r")
    one.tracks.twist(0.0, 0.4)
    run(one, 20.0)
    assert one.tracks.odometry_turn == pytest.approx(0.2, rel=0.01)


def test_a_residual_of_the_controller_survives_a_stop() -> None:
    one = made("ic120")
    one.tracks.twist(1.0, 0.0)
    run(one, 1.0)
    one.tracks.twist(0.0, 0.0)
    run(one, 5.0)
    assert one.tracks.forward == 0.0
    assert one.tracks.left.residual > 30.0
    one.tracks.twist(0.01, 0.0)
    run(one, 1.0)
    assert one.tracks.forward > 0.04  # it creeps off faster than it is told
    plain = made("zx200")
    plain.tracks.twist(1.0, 0.0)
    run(plain, 1.0)
    assert plain.tracks.left.residual == 0.0


@pytest.mark.parametrize("model", ["zx200", "zx120"])
def test_swinging_turns_the_base(model: str) -> None:
    for kick, least, most in ((0.08, 1.0, 5.0), (0.0, 0.0, 0.0)):
        one = made(model, kick=kick)
        run(one, 5.0)
        one.angle("swing_joint", 0.8)
        run(one, 10.0)
        assert least <= -math.degrees(one.base.yaw) <= most
        assert one.tracks.odometry == (0.0, 0.0, 0.0)


def test_a_machine_falls_to_the_ground_in_the_first_second() -> None:
    one = made("zx200", height=1.68)
    run(one, 0.5)
    assert 0.0 < one.base.z < 1.0
    run(one, 0.5)
    assert one.base.z == 0.0
