"""Goals, preemption, emergency stop and faults of a whole stand-in."""

import math

import pytest

from tms_config.config import CONFIGS
from tms_config.models import Border, MachineModel
from tms_config.site_file import Fault
from tms_config.yaml_file import parse
from tms_control.reference_trajectory import Knot
from tms_sim.base import Leg
from tms_sim.machine import StandIn
from tms_sim.motion import Motion
from tms_sim.navigator import PATIENCE, Navigator

CARRIER = parse(CONFIGS / "machines" / "mst110cr.yaml", MachineModel)
DIGGER = parse(CONFIGS / "machines" / "zx200.yaml", MachineModel)


class Died(Exception):
    pass


def machine(model: MachineModel = CARRIER, ideal: bool = True, **fault: object) -> StandIn:
    def die() -> None:
        raise Died

    return StandIn(model, (0.0, 0.0, 0.0), Fault.model_validate(fault), die, model.borders["sim"], ideal)


def navigator(made: StandIn) -> Navigator:
    assert made.navigator is not None
    return made.navigator


def run(made: StandIn, seconds: float) -> None:
    for _ in range(round(seconds / 0.2)):
        made.step(0.2)


def ended(motion: Motion) -> str:
    return motion.verdict.outcome if motion.verdict else "open"


def test_it_starts_where_its_border_says_else_as_its_model() -> None:
    starts = DIGGER.borders["physx"].initial
    made = StandIn(DIGGER, (0.0, 0.0, 0.0), Fault(), lambda: None, DIGGER.borders["physx"])
    assert dict(zip(made.arm.joints, made.arm.positions, strict=True)) == {**DIGGER.initial, **starts}
    assert machine(DIGGER).arm.positions == list(DIGGER.initial.values()) != made.arm.positions


def test_the_bed_tips_and_the_body_turns_at_the_same_time() -> None:
    made = machine()
    tip, turn = made.turner.begin("dump_joint", -1.0), made.turner.begin("rotate_joint", 1.5)
    run(made, 1)
    assert ended(tip) == ended(turn) == "open"
    run(made, 12)
    assert ended(tip) == ended(turn) == "SUCCEEDED"
    assert made.arm.positions == pytest.approx([1.5, -1.0], abs=0.006)


def test_a_joint_that_turns_for_ever_takes_the_shorter_way() -> None:
    made = machine(CARRIER.model_copy(update={"initial": {"rotate_joint": 3.0}}))
    made.turner.begin("rotate_joint", -3.0)
    run(made, 5)
    assert made.arm.positions[0] == pytest.approx(math.tau - 3.0, abs=0.006)


@pytest.mark.parametrize(("angle", "said"), [(-1.2, "below its limit"), (0.1, "above its limit"), (math.nan, "number")])
def test_angles_outside_the_limits_are_refused(angle: float, said: str) -> None:
    assert said in (machine().turner.refusal("dump_joint", angle) or "")


def test_a_newer_goal_preempts_and_a_cancel_brakes() -> None:
    made = machine()
    first = made.turner.begin("dump_joint", -1.0)
    run(made, 1)
    second = made.turner.begin("dump_joint", -0.9)
    assert ended(first) == "ABORTED"
    made.turner.cancel(second)
    run(made, 2)
    assert ended(second) == "CANCELED" and made.arm.still and made.arm.positions[1] > -0.3


def test_waypoints_that_cannot_be_reached_are_told_and_the_rest_is_driven() -> None:
    made = machine()
    trip = navigator(made).begin([Leg(2, 0, 0), Leg(4, 0, 0), Leg(6, 0, 0)], waypoints=True, miss=(1, 7))
    assert navigator(made).current(trip) == 0
    run(made, 30)
    assert (ended(trip), trip.missed) == ("SUCCEEDED", [1])
    assert made.base is not None and made.base.x == pytest.approx(6, abs=0.1)


def test_an_empty_path_is_aborted() -> None:
    made = machine()
    trip = navigator(made).begin([])
    run(made, 1)
    assert ended(trip) == "ABORTED"


@pytest.mark.parametrize("model", [CARRIER, DIGGER], ids=["carrier", "digger"])
def test_the_emergency_stop_ends_everything_until_it_is_released(model: MachineModel) -> None:
    made = machine(model)
    trip = navigator(made).begin([Leg(20, 0, 0)])
    run(made, 3)
    made.stop(True)
    run(made, 4)
    assert ended(trip) == "ABORTED" and made.base is not None and made.base.still
    made.drive(1.0, 0.0)
    run(made, 1)
    assert made.base.still and navigator(made).refusal([]) is not None
    made.stop(False)
    made.drive(1.0, 0.0)
    run(made, 1)
    assert made.base.v > 0


def test_a_machine_that_stalls_is_given_up_by_the_navigation() -> None:
    made = machine(stall=2.0)
    trip = navigator(made).begin([Leg(20, 0, 0)])
    run(made, 2 + PATIENCE - 1)
    assert ended(trip) == "open" and made.base is not None and made.base.still and made.base.x < 2
    run(made, 3)
    assert ended(trip) == "ABORTED" and "no progress" in (trip.verdict.text if trip.verdict else "")


def test_an_arm_that_stalls_misses_its_goal() -> None:
    made = machine(DIGGER, stall=0.5)
    names = list(DIGGER.joints)
    start = [DIGGER.initial[name] for name in names]
    motion = made.controller.begin(names, [Knot(3.0, (1.0, *start[1:]))], goal_time=5.0)
    run(made, 7)
    assert ended(motion) == "open" and not any(made.arm.velocities)
    run(made, 2)
    assert ended(motion) == "ABORTED" and "swing_joint" in (motion.verdict.text if motion.verdict else "")


def test_a_late_machine_obeys_late() -> None:
    made = machine(late=1.0)
    made.drive(1.0, 0.0)
    run(made, 0.8)
    assert made.base is not None and made.base.still
    run(made, 1)
    assert made.base.v > 0


def test_a_machine_that_creeps_says_so_and_moves() -> None:
    made = machine(drift=0.05)
    run(made, 10)
    assert made.arm.velocities[0] == pytest.approx(0.05)
    assert made.base is not None and made.base.leak == 0.05 and made.base.x == pytest.approx(0.5)


def test_it_dies_only_in_motion() -> None:
    made = machine(die=1.0)
    run(made, 5)
    navigator(made).begin([Leg(20, 0, 0)])
    with pytest.raises(Died):
        run(made, 2)


def test_a_dump_that_returns_is_one_goal_that_nothing_ends() -> None:
    model = parse(CONFIGS / "machines" / "ic120.yaml", MachineModel)
    border = model.borders["physx"].model_copy(update={"dump_returns": True})
    made = StandIn(model, (0.0, 0.0, 0.0), Fault(), lambda: None, border, ideal=True)
    cycle = made.turner.begin("vessel_pin_joint", -0.6)
    run(made, 5)
    made.turner.cancel(cycle)
    assert made.arm.positions[0] == pytest.approx(-0.6, abs=0.006)
    run(made, 2)
    assert ended(cycle) == "open"
    run(made, 6)
    assert ended(cycle) == "SUCCEEDED"
    assert made.arm.positions[0] == pytest.approx(0.0, abs=0.006)
    lowered = made.turner.begin("vessel_pin_joint", 0.0)
    run(made, 0.4)
    assert ended(lowered) == "SUCCEEDED"


def test_joint_commands_move_by_angle_or_by_velocity() -> None:
    made = machine()
    made.turn(["dump_joint", "no_such_joint"], 0, [-0.5, 1.0], [])
    run(made, 8)
    assert made.arm.positions[1] == pytest.approx(-0.5, abs=0.002)
    made.turn(["dump_joint"], 0, [-9.0], [])
    run(made, 12)
    assert made.arm.positions[1] == pytest.approx(-1.0472, abs=0.002)  # as far as it goes
    made.turn(["rotate_joint"], 1, [], [0.2])
    run(made, 5)
    assert made.arm.velocities[0] == pytest.approx(0.2)
    goal = made.turner.begin("rotate_joint", 0.0)
    run(made, 20)
    assert ended(goal) == "SUCCEEDED"
    run(made, 5)
    assert made.arm.velocities[0] == 0.0  # the velocity is forgotten with the goal


@pytest.mark.parametrize(
    ("control", "position", "velocity", "said"),
    [(0, [], [1.0], "0 positions for 1 joints"), (1, [1.0], [], "0 velocities"), (2, [1.0], [1.0], "control_type 2")],
)
def test_joint_commands_that_say_nothing(control: int, position: list[float], velocity: list[float], said: str) -> None:
    assert said in (machine().commands.take(["dump_joint"], control, position, velocity) or "")


def test_the_emergency_stop_ends_joint_commands_too() -> None:
    made = machine()
    made.turn(["rotate_joint"], 1, [], [0.2])
    run(made, 3)
    made.stop(True)
    made.turn(["rotate_joint"], 1, [], [0.2])
    run(made, 3)
    assert made.arm.still
    made.stop(False)
    run(made, 3)
    assert made.arm.still


def test_names_of_the_border_are_taken_for_joints() -> None:
    made = StandIn(CARRIER, (0.0, 0.0, 0.0), Fault(), lambda: None, Border(joints={"dump_joint": "vessel_pin_joint"}))
    made.turn(["vessel_pin_joint"], 0, [-0.2], [])
    run(made, 5)
    assert made.arm.positions[1] == pytest.approx(-0.2, abs=0.002)
