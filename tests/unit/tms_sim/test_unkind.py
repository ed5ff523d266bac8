"""Faults of the motion: what the machine truly does."""

from collections.abc import Callable

import pytest

from tms_config.config import CONFIGS
from tms_config.models import MachineModel
from tms_config.site_file import Fault
from tms_config.yaml_file import parse
from tms_control.reference_trajectory import Knot
from tms_sim.base import Base, Leg
from tms_sim.machine import CREEPS, StandIn
from tms_sim.navigator import Trip

DIGGER = parse(CONFIGS / "machines" / "zx200.yaml", MachineModel)
NAMES = list(DIGGER.joints)
HERE = tuple(DIGGER.initial[name] for name in NAMES)
STEP = 0.04
Order = Callable[[StandIn, Trip], None]


def machine(**fault: object) -> StandIn:
    return StandIn(
        DIGGER, (0.0, 0.0, 0.0), Fault.model_validate(fault), lambda: None, DIGGER.borders["sim"]
    )  # fmt: skip


def base(made: StandIn) -> Base:
    assert made.base is not None
    return made.base


def run(made: StandIn, seconds: float) -> None:
    for _ in range(round(seconds / STEP)):
        made.step(STEP)


def driving(made: StandIn) -> Trip:
    assert made.navigator is not None
    trip = made.navigator.begin([Leg(80, 0, 0)])
    run(made, 4)
    assert base(made).v == pytest.approx(1.0, abs=0.01)
    return trip


def cancel(made: StandIn, trip: Trip) -> None:
    navigator = made.navigator
    assert navigator is not None
    made.cancel(lambda: navigator.cancel(trip))


def press(made: StandIn, _trip: Trip) -> None:
    made.stop(True)


@pytest.mark.parametrize("order", [cancel, press], ids=["cancel", "emg_stop"])
def test_without_a_fault_every_order_stops(order: Order) -> None:
    made = machine()
    order(made, driving(made))
    run(made, 1)
    assert base(made).still


@pytest.mark.parametrize("order", [cancel, press], ids=["cancel", "emg_stop"])
def test_coast_goes_on_as_it_was_and_then_obeys(order: Order) -> None:
    made = machine(coast=3.0)
    trip = driving(made)
    order(made, trip)
    run(made, 1)
    order(made, trip)  # asked again, it coasts no longer
    run(made, 1.9)
    assert base(made).v == pytest.approx(1.0, abs=0.01) and trip.verdict is None
    run(made, 1.1)
    assert base(made).still and trip.verdict is not None


def test_a_stop_that_was_released_while_it_coasted_does_not_come_back() -> None:
    made = machine(coast=3.0)
    press(made, driving(made))
    run(made, 1)
    made.stop(False)
    run(made, 5)
    assert base(made).v == pytest.approx(1.0, abs=0.01)
    assert made.navigator is not None and made.navigator.refusal([]) is None


def test_coast_after_a_zero() -> None:
    made = machine(coast=3.0)
    made.drive(1.0, 0.0)
    run(made, 8)
    made.drive(0.0, 0.0)
    run(made, 2.9)
    assert base(made).v > 0.9
    run(made, 1.1)
    assert base(made).still


def test_a_trajectory_coasts_too() -> None:
    made = machine(coast=3.0)
    motion = made.controller.begin(NAMES, [Knot(6.0, (2.5, *HERE[1:]))])
    run(made, 3)
    made.cancel(lambda: made.controller.cancel(motion))
    speed = made.arm.velocities[0]
    run(made, 2.9)
    assert made.arm.velocities[0] > 0.6 * speed > 0.2
    run(made, 5)
    assert motion.verdict is not None and made.arm.still


@pytest.mark.parametrize(
    ("fault", "deaf", "received"),
    [({"ignore_cancel": True}, cancel, press), ({"ignore_emg_stop": True}, press, cancel)],
    ids=["ignore_cancel", "ignore_emg_stop"],
)
def test_one_order_is_ignored_and_the_other_is_not(fault: dict[str, bool], deaf: Order, received: Order) -> None:
    made = machine(**fault)
    trip = driving(made)
    deaf(made, trip)
    run(made, 5)
    assert base(made).v == pytest.approx(1.0, abs=0.01) and trip.verdict is None
    received(made, trip)
    run(made, 1)
    assert base(made).still and trip.verdict is not None


def test_dead_time_lets_it_move_after_its_controller_thinks_it_stands() -> None:
    made = machine(dead_time=1.5)
    motion = made.controller.begin(NAMES, [Knot(2.0, (1.0, *HERE[1:]))])
    run(made, 1.0)
    made.cancel(lambda: made.controller.cancel(motion))
    ended = None
    for _ in range(200):
        made.step(STEP)
        if motion.verdict and ended is None:
            ended = made.arm.positions[0]
    assert ended is not None
    assert abs(made.arm.positions[0] - ended) > 0.01


def test_dead_time_of_the_tracks() -> None:
    made = machine()
    run(made, 1)
    made.fault = Fault(dead_time=1.0)
    made.drive(1.0, 0.0)
    run(made, 0.9)
    assert base(made).v == 0.0
    run(made, 0.3)
    assert base(made).v > 0.0


def test_creep_leaves_stand_still_after_a_while_and_truly_moves() -> None:
    made = machine(creep=0.1)
    trip = driving(made)
    cancel(made, trip)
    run(made, 1)
    assert base(made).still
    place, angle = base(made).x, made.arm.positions[0]
    run(made, CREEPS - 1)
    assert base(made).x == place
    run(made, 2)
    assert base(made).leak == 0.1 and base(made).x - place > 0.1
    assert made.arm.velocities[0] == pytest.approx(0.1) and made.arm.positions[0] - angle > 0.1
    made.stop(True)  # a leak: no order stops it
    run(made, 1)
    assert base(made).x - place > 0.2
    made.fault = Fault()
    run(made, 0.2)
    place = base(made).x
    run(made, 2)
    assert base(made).x == place and base(made).leak == 0.0 and not any(made.arm.velocities)


def test_a_leak_ends_at_the_end_stop() -> None:
    model = parse(CONFIGS / "machines" / "ic120.yaml", MachineModel)
    made = StandIn(model, (0.0, 0.0, 0.0), Fault(drift=0.1), lambda: None, model.borders["sim"])
    run(made, 2)
    assert made.arm.positions == [0.0] and made.arm.velocities == [0.0]


def test_stall_loses_what_is_under_way() -> None:
    made = machine(stall=2.0)
    motion = made.controller.begin(NAMES, [Knot(3.0, (1.0, *HERE[1:]))], goal_time=3.0)
    run(made, 2.1)
    there = made.arm.positions
    assert there[0] > 0.01 and not any(made.arm.velocities)
    run(made, 8)
    assert motion.verdict is not None and motion.verdict.outcome == "ABORTED"
    run(made, 5)
    assert made.arm.positions == there


def test_stall_is_counted_anew_for_each_goal() -> None:
    made = machine(stall=2.0)
    for _ in range(2):
        assert made.navigator is not None
        trip = made.navigator.begin([Leg(80, 0, 0)])
        run(made, 1.9)
        assert base(made).v > 0.5
        run(made, 0.3)
        assert base(made).v == 0.0
        cancel(made, trip)
        run(made, 1)


def test_a_stop_that_is_repeated_holds_where_the_first_one_found_it() -> None:
    once, again = machine(), machine()
    for made in (once, again):
        made.controller.begin(NAMES, [Knot(4.0, (2.0, *HERE[1:]))])
        run(made, 3)
        made.stop(True)
    for _ in range(10):
        again.stop(True)
        run(again, 0.2)
    run(once, 2)
    assert once.arm.positions == again.arm.positions


def test_everything_is_ideal_where_the_site_says_so() -> None:
    made = StandIn(DIGGER, (0.0, 0.0, 0.0), Fault(), lambda: None, DIGGER.borders["sim"], ideal=True)
    motion = made.controller.begin(NAMES, [Knot(2.0, (0.2, *HERE[1:]))])
    run(made, 0.2)
    assert made.arm.velocities[0] > 0.05
    run(made, 4)
    assert motion.verdict is not None and motion.verdict.outcome == "SUCCEEDED"
