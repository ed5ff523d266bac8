"""When a machine counts as seen to stand, whatever it reports."""

from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tms_config.models import Border, MachineModel
from tms_machine.facts import machine_facts
from tms_proof.facts import MachineFacts, SourceFacts, StillFacts
from tms_proof.proof import NOTHING, UNKNOWN, Expected
from tms_proof.reasons import (
    ClockAhead,
    JointStates,
    ManyPublishers,
    NewClock,
    NoSource,
    Odometry,
    Old,
    OldOf,
    PositionsMove,
    StampRepeated,
    TwoPublishers,
    Unheard,
    UnheardOf,
    UtcClock,
    VelocitiesMove,
)
from tms_proof.source import SourceSample
from tms_proof.stamps import REMEMBERED
from tms_proof.standstill import (
    HEADING,
    IMU,
    JOINTS,
    ODOM,
    PLACE,
    TURNING,
    StandStill,
    Travel,
)
from tms_reason.texts import text

LIMIT, PERIOD, DEAD = 0.01, 0.04, 0.6  # rad/s, s, s
COASTS = 3.0  # s that machines of the drill go on after an order to stop
SOURCE = {"period": PERIOD, "stamps": "utc", "frozen_after": 2.0, "origin": "a test"}


def model(**changes: object) -> MachineModel:
    joint = {"min": -3.0, "max": 3.0, "velocity": 1.0, "acceleration": 1.0, "jerk": 2.0}
    data: dict[str, object] = {
        "kind": "backhoe",
        "joints": {"boom": joint, "arm": joint},
        "geometry": {},
        "response": {name: {"dead_time": DEAD, "lag": 0.5, "origin": "a test"} for name in ("boom", "arm")},
        "still": {"velocity": LIMIT, "linear": 0.02, "angular": 0.01, "seconds": 0.2, "origin": "a test"},
        "borders": {},
    }
    return MachineModel.model_validate({**data, **changes})


def watch(stamps: str = "utc", odom: bool = False, immediate: bool = False) -> StandStill:
    sources: dict[str, object] = {JOINTS: {**SOURCE, "stamps": stamps}}
    border: dict[str, object] = {"joint_states": "joint_states", "sources": sources}
    if odom:
        border["odom"], sources[ODOM] = "odom", SOURCE
    if immediate:
        border |= {"emg_stop": "emg_stop", "emg_stop_at_once": True}
    return StandStill(machine_facts("zx200", model(), Border.model_validate(border)))


class Reporter:
    """Joint states of two joints, as some driver sends them."""

    def __init__(self, made: StandStill) -> None:
        self.watch, self.number, self.now = made, 0, 100.0
        self.angle = 0.0

    def publish_now(self, angle: float, speed: float | None, stamp: float | None = None, arm: bool = True) -> None:
        self.number += 1
        names = ["boom", "arm"] if arm else ["boom"]
        self.watch.take(JOINTS, SourceSample(
            self.now, (self.now if stamp is None else stamp) + 1e9, self.number,
            {name: (angle,) for name in names}, {} if speed is None else dict.fromkeys(names, speed),
        ))  # fmt: skip

    def run(self, seconds: float, speed: float, reported: float | None = None) -> None:
        """Go at a speed for some time."""
        for _ in range(round(seconds / PERIOD)):
            self.now += PERIOD
            self.angle += speed * PERIOD
            self.publish_now(self.angle, speed if reported is None else reported)


def stood_after(
    reporter: Reporter,
    step: Callable[[], None],
    begun: float,
    limit: float = 8.0,
    strongest: bool = False,
    expected: Expected = NOTHING,
) -> float:
    """Seconds from the stop until it is proven; infinite when it is not."""
    wanted = reporter.watch.proof(begun, strongest, expected)
    while reporter.now - begun < limit:
        if reporter.watch.proven(wanted, reporter.now):
            return reporter.now - begun
        step()
    return float("inf")


def standing(reporter: Reporter) -> Callable[[], None]:
    return lambda: reporter.run(PERIOD, 0.0)


def test_nothing_heard_is_not_standing() -> None:
    made = watch()
    assert made.moving()
    assert not made.standing(100.0)
    assert made.silent(0.0, 1.0) == Unheard(JointStates(), "/zx200/joint_states")
    assert made.age(5.0) == float("inf")


def test_a_stop_is_proven_after_the_dead_time_and_a_while_of_standing() -> None:
    reporter = Reporter(watch())
    reporter.run(1.0, 0.0)
    assert DEAD + 0.2 <= stood_after(reporter, standing(reporter), reporter.now) < DEAD + 0.35


def test_a_command_on_its_way_moves_the_machine_after_the_stop() -> None:
    """Dead time 0.6 s, stop 0.1 s after the goal left: it stands, then it moves."""
    reporter = Reporter(watch())
    reporter.run(1.0, 0.0)
    begun = reporter.now

    def step() -> None:
        reporter.run(PERIOD, 0.3 if 0.5 < reporter.now - begun < 2.0 else 0.0)

    assert 2.2 < stood_after(reporter, step, begun) < 2.7


def test_a_velocity_field_of_zeros_proves_nothing() -> None:
    reporter = Reporter(watch())
    reporter.run(1.0, 0.3, reported=0.0)
    trouble = reporter.watch.trouble(reporter.now)
    assert trouble is not None and trouble.reason.find(PositionsMove) is not None
    assert stood_after(reporter, lambda: reporter.run(PERIOD, 0.3, reported=0.0), reporter.now) == float("inf")


def test_a_motion_that_lost_messages_hide_is_no_lie() -> None:
    """The receiver was held up: it hears of the rest before the motion, then of the rest after it."""
    reporter = Reporter(watch())
    reporter.run(1.0, 0.0)
    measured = reporter.now
    reporter.now += 1.5
    for late in (PERIOD, *(1.5 + PERIOD * number for number in range(6))):
        reporter.now += PERIOD
        reporter.angle += 0.5 * (late == 1.5)
        reporter.publish_now(reporter.angle, 0.0, stamp=measured + late)
    assert reporter.watch.trouble(reporter.now) is None
    assert reporter.watch.moving()


def test_velocities_that_go_on_while_positions_stand_are_implausible() -> None:
    reporter = Reporter(watch())
    reporter.run(1.0, 0.0, reported=0.3)
    trouble = reporter.watch.trouble(reporter.now)
    assert trouble is not None and trouble.reason.find(VelocitiesMove) is not None


def test_a_joint_that_turns_back_is_no_lie() -> None:
    """It is where it was seven messages ago, and each velocity says that it moves."""
    reporter = Reporter(watch())
    reporter.run(1.0, 0.3)
    for _ in range(4):
        reporter.run(PERIOD, -0.3 * 3 / 4)
        assert reporter.watch.trouble(reporter.now) is None


def test_a_reported_stop_before_the_stop_does_not_count() -> None:
    """It says 0.3 s before the stop that it stands, and moves on."""
    reporter = Reporter(watch())
    reporter.run(1.0, 0.3)
    reporter.run(0.32, 0.0)
    assert stood_after(reporter, lambda: reporter.run(PERIOD, 0.3), reporter.now) == float("inf")


def test_old_messages_that_come_late_do_not_count() -> None:
    """Measured before the stop, received after it."""
    reporter = Reporter(watch())
    reporter.run(1.0, 0.0)
    begun = reporter.now

    def late() -> None:
        reporter.now += PERIOD
        reporter.publish_now(0.0, 0.0, stamp=reporter.now - 1.5)

    reporter.watch.take(
        JOINTS, SourceSample(reporter.now, 1e9 + reporter.now - 1.5, 999, {"boom": (0.0,)}, {"boom": 0.0})
    )
    assert stood_after(reporter, late, begun, limit=1.4) == float("inf")


def test_a_frozen_stamp_is_silence() -> None:
    reporter = Reporter(watch())
    reporter.run(1.0, 0.0)
    frozen = reporter.now

    def again() -> None:
        reporter.now += PERIOD
        reporter.publish_now(0.0, 0.0, stamp=frozen)

    assert stood_after(reporter, again, reporter.now) == float("inf")
    trouble = reporter.watch.trouble(reporter.now)
    assert trouble is not None and trouble.reason == StampRepeated(JointStates())


def test_a_joint_that_was_never_heard_is_unknown() -> None:
    reporter = Reporter(watch())

    def one_of_two() -> None:
        reporter.now += PERIOD
        reporter.publish_now(0.0, 0.0, arm=False)

    assert stood_after(reporter, one_of_two, reporter.now) == float("inf")
    assert reporter.watch.silent(reporter.now, 1.0) == UnheardOf(JointStates(), "arm", "/zx200/joint_states")


def test_two_publishers_prove_nothing() -> None:
    reporter = Reporter(watch())
    reporter.run(1.0, 0.0)
    reporter.watch.sources[JOINTS].publishers = ("/driver", "/stranger")
    assert stood_after(reporter, standing(reporter), reporter.now) == float("inf")
    assert reporter.watch.obstacle(reporter.now) == ManyPublishers(JointStates(), 2, ("/driver", "/stranger"))


def test_numbers_of_two_publishers_go_back_and_forth() -> None:
    reporter = Reporter(watch())
    for number in (100, 5, 101, 6, 102):
        reporter.now += 0.01
        reporter.watch.take(JOINTS, SourceSample(reporter.now, 1e9 + reporter.now, number, {"boom": (0.0,)}, {}))
    trouble = reporter.watch.trouble(reporter.now)
    assert trouble is not None and trouble.reason == TwoPublishers(JointStates())


def test_a_publisher_that_was_started_again_is_no_second_one() -> None:
    reporter = Reporter(watch())
    reporter.run(0.4, 0.0)
    reporter.number = 0
    reporter.run(0.4, 0.0)
    assert reporter.watch.trouble(reporter.now) is None


def test_the_worst_speed_counts_and_not_the_last_message() -> None:
    reporter = Reporter(watch())

    def both() -> None:  # every other message says that it stands
        reporter.now += PERIOD / 2
        reporter.angle += 0.3 * PERIOD / 2
        reporter.publish_now(reporter.angle, 0.3)
        reporter.now += PERIOD / 2
        reporter.publish_now(reporter.angle, 0.0)

    assert stood_after(reporter, both, reporter.now) == float("inf")


def test_a_clock_that_jumps_back_is_a_new_one() -> None:
    reporter = Reporter(watch("since_start"))
    reporter.run(1.0, 0.0)
    shift = -50.0

    def restarted() -> None:
        reporter.now += PERIOD
        reporter.publish_now(0.0, 0.0, stamp=reporter.now + shift)

    restarted()
    trouble = reporter.watch.trouble(reporter.now)
    assert trouble is not None and trouble.passes
    assert text(trouble.reason, "en") == "joint states: the simulator's clock jumped back by 50.0 s"
    begun = reporter.now
    while reporter.watch.trouble(reporter.now) is not None:
        assert reporter.now - begun < 8.0
        restarted()
        reporter.watch.settle(reporter.now)
    assert reporter.now - begun >= 5.0


def test_a_stamp_ahead_of_its_clock_names_the_clock() -> None:
    reporter = Reporter(watch())
    reporter.run(1.0, 0.0)
    reporter.now += PERIOD
    reporter.publish_now(0.0, 0.0, stamp=reporter.now + 3.2)
    trouble = reporter.watch.trouble(reporter.now)
    assert trouble is not None
    assert isinstance(trouble.reason, NewClock) and isinstance(trouble.reason.why, ClockAhead)
    assert (trouble.reason.why.clock, round(trouble.reason.why.seconds, 1)) == (UtcClock(), 3.2)
    reporter.watch.accept_clocks()
    assert reporter.watch.trouble(reporter.now) is None


def test_without_stamps_the_arrival_counts_and_the_receipt_can_say_so() -> None:
    reporter = Reporter(watch("none"))
    reporter.run(1.0, 0.0)
    assert stood_after(reporter, standing(reporter), reporter.now) < DEAD + 0.4
    assert reporter.watch.unstamped == [JointStates()]


def test_a_joint_where_it_cannot_be_is_told() -> None:
    reporter = Reporter(watch())
    reporter.now += PERIOD
    reporter.publish_now(3.5, 0.0)
    trouble = reporter.watch.trouble(reporter.now)
    assert trouble is not None
    assert text(trouble.reason, "en") == "joint states: boom is told at 3.500 rad, where it cannot be (limit 3.000 rad)"


def test_a_stop_that_acts_at_once_is_proven_at_once_when_it_is_seen_to_act() -> None:
    reporter = Reporter(watch(immediate=True))
    reporter.watch.commanded(reporter.now)
    reporter.run(1.0, 0.3)
    assert stood_after(reporter, standing(reporter), reporter.now, strongest=True) < DEAD


def test_a_stop_that_acts_at_once_waits_where_nothing_was_seen_to_move() -> None:
    reporter = Reporter(watch(immediate=True))
    reporter.run(1.0, 0.0)
    reporter.watch.commanded(reporter.now)
    assert stood_after(reporter, standing(reporter), reporter.now, strongest=True) > DEAD


def test_a_stop_that_acts_at_once_waits_where_a_motion_had_hardly_begun() -> None:
    """A machine that goes on, and replays its record from before it moved: nobody would notice the jump back."""
    reporter = Reporter(watch(immediate=True))
    reporter.run(1.0, 0.0)
    reporter.watch.commanded(reporter.now)
    reporter.run(PERIOD, 0.2)
    reporter.angle = 0.0
    assert stood_after(reporter, standing(reporter), reporter.now, strongest=True) > DEAD


@pytest.mark.parametrize(("late", "at_once"), [(0.5 * DEAD, False), (1.2 * DEAD, True)])
def test_a_stop_that_acts_at_once_is_not_seen_on_the_motion_of_the_goal_before(late: float, at_once: bool) -> None:
    """The next goal has left; until the dead time is over, only the end of the last motion can be seen."""
    reporter = Reporter(watch(immediate=True))
    reporter.watch.leaves(reporter.now)
    reporter.run(1.0, 0.3)
    left = reporter.now
    assert reporter.watch.leaves(left) == reporter.watch.positions
    reporter.run(late, 0.3)
    assert (reporter.watch.proof(reporter.now, strongest=True).start == reporter.now) is at_once


@pytest.mark.parametrize("strongest", [False, True])
@pytest.mark.parametrize("before", [0.0, 0.4], ids=["from its begin on", "for a while before"])
def test_sources_that_could_not_be_believed_meanwhile_make_the_proof_wait(strongest: bool, before: float) -> None:
    """Its stamps stand, and then it replays its record from before the motion, while it goes on."""
    reporter = Reporter(watch(immediate=strongest))
    reporter.run(1.0, 0.3)
    stamp = reporter.now
    reporter.watch.commanded(reporter.now)

    def same_stamp(seconds: float) -> None:
        for _ in range(round(seconds / PERIOD)):
            reporter.now += PERIOD
            reporter.publish_now(reporter.angle, 0.3, stamp)

    same_stamp(before)
    begun, left = reporter.now, [same_stamp] * round(1.0 / PERIOD)
    reporter.angle = 0.0
    waited = stood_after(
        reporter, lambda: left.pop()(PERIOD) if left else standing(reporter)(), begun, strongest=strongest
    )
    assert COASTS + reporter.watch.dead_time + reporter.watch.braking < waited < 8.0


def test_a_motion_that_was_never_seen_makes_the_proof_wait() -> None:
    """A replayed record stands, whatever the machine does: it may go on, and brake then."""
    reporter = Reporter(watch())
    since = reporter.now
    reporter.run(1.0, 0.0)
    waited = stood_after(reporter, standing(reporter), reporter.now, expected=Expected(since))
    assert waited > COASTS + reporter.watch.dead_time + reporter.watch.braking


def test_a_gateway_that_was_started_anew_waits_for_every_motion_whatever_it_sees() -> None:
    """A record of the last 2 s in which a motion had just begun, again and again, of a machine that coasts."""
    reporter = Reporter(watch())
    record = [0.0] * 34 + [0.0001 * i * i for i in range(1, 7)]
    begun, i = reporter.now, 0

    def replay() -> None:
        nonlocal i
        i += 1
        reporter.now += PERIOD
        place, before = record[i % len(record)], record[(i - 1) % len(record)]
        reporter.publish_now(place, max(0.0, (place - before) / PERIOD), reporter.now)

    assert stood_after(reporter, replay, begun, expected=UNKNOWN) > COASTS + reporter.watch.dead_time
    reporter, i = Reporter(watch()), 0
    begun = reporter.now
    seen = Expected(begun)
    assert stood_after(reporter, replay, begun, expected=seen) < COASTS, "this record would have been believed"


@pytest.mark.parametrize(
    ("begun", "way", "seen"), [(0.5, 0.2, False), (0.45, 0.2, False), (0.35, 0.2, True), (0.5, 0.002, True)]
)
def test_a_motion_that_has_come_shows_another_place(begun: float, way: float, seen: bool) -> None:
    """A record of another motion shows a motion, too."""
    assert Expected(1.0, {}, {"boom": (begun, way)}).seen(2.0, {}, {"boom": 0.5}) is seen
    assert Expected(1.0, {}, {"arm": (begun, way)}).seen(2.0, {}, {"boom": 0.5}) is (way == 0.002)


@pytest.mark.parametrize(("commanded", "comes"), [(0.2, 0.0), (0.008, 0.2)], ids=["nothing comes", "a part comes"])
def test_what_was_commanded_before_the_stop_must_be_seen_after_it(commanded: float, comes: float) -> None:
    """A record that is replayed from the first moment of a motion on shows a motion, and then stands.

    Of a small motion a first part may come, and the rest after a pause: where the dead time grows while a goal begins.
    """
    reporter = Reporter(watch())
    since = reporter.now
    reporter.run(0.2, 0.02)
    begun, expected = reporter.now, Expected(since, {"boom": commanded})
    reporter.watch.mark()
    reporter.run(comes, 0.012)
    waited = stood_after(reporter, standing(reporter), begun, expected=expected)
    assert waited > COASTS + reporter.watch.dead_time + reporter.watch.braking


def test_a_second_stop_waits_for_what_the_first_one_waits_for() -> None:
    made = watch()
    first = made.proof(100.0, strongest=False, expected=Expected(99.0, {"boom": 0.2}))
    second = made.proof(100.5, strongest=False)
    both = second.after(first)
    assert (both.start, both.unseen) == (second.start, second.unseen)
    assert both.expected == Expected(99.0, {"boom": 0.2})
    cuts = watch(immediate=True)
    pressed = cuts.proof(100.5, strongest=True)
    both = pressed.after(first)
    assert both.start == pressed.start and both.expected.to_come == {}  # nothing that was on its way comes any more
    assert (both.expected.since, both.unseen) == (99.0, pressed.unseen)  # but what has come must have been seen


def test_what_was_commanded_before_the_stop_and_seen_after_it_is_believed() -> None:
    reporter = Reporter(watch())
    since = reporter.now
    reporter.run(0.4, 0.3)
    begun, expected = reporter.now, Expected(since, {"boom": 0.2})
    reporter.watch.mark()

    def moves() -> None:
        reporter.run(PERIOD, 0.3 if reporter.now - begun < DEAD else 0.0)

    assert stood_after(reporter, moves, begun, expected=expected) < DEAD + 0.7


def test_a_replayed_record_is_never_proven() -> None:
    """Its last 2 s again and again: standing, then slow motion, then back."""
    reporter = Reporter(watch())
    record = [0.0] * 36 + [0.002 * i for i in range(1, 15)]

    def replay(i: int) -> None:
        reporter.now += PERIOD
        at = record[i % len(record)]
        speed = 0.05 if i % len(record) >= 36 else 0.0
        reporter.publish_now(at, speed)

    for i in range(len(record)):
        replay(i)
    count = iter(range(10_000))
    assert stood_after(reporter, lambda: replay(next(count)), reporter.now) == float("inf")


def test_a_machine_that_drives_does_not_stand() -> None:
    reporter = Reporter(watch(odom=True))
    reporter.run(0.4, 0.0)
    assert reporter.watch.silent(reporter.now, 1.0) == Unheard(Odometry(), "/zx200/odom")
    x = 0.0

    def drive(speed: float) -> Callable[[], None]:
        def step() -> None:
            nonlocal x
            reporter.run(PERIOD, 0.0)
            x += speed * PERIOD
            reporter.watch.take(ODOM, SourceSample(
                reporter.now, reporter.now, reporter.number, {PLACE: (x, 0.0), HEADING: (0.0,)},
                {PLACE: speed, HEADING: 0.0},
            ))  # fmt: skip

        return step

    assert stood_after(reporter, drive(0.5), reporter.now, limit=3.0) == float("inf")
    assert stood_after(reporter, drive(0.0), reporter.now) < DEAD + 0.4


def test_travel_counts_from_the_mark() -> None:
    reporter = Reporter(watch())
    reporter.run(0.4, 0.0)
    reporter.watch.mark()
    reporter.run(0.4, 0.5)
    reporter.run(0.2, -0.5)
    travel = reporter.watch.travel()
    assert (travel.joint, round(travel.angle, 6), travel.way) == ("boom", 0.2, 0.0)
    reporter.watch.mark()
    assert reporter.watch.travel() == Travel()


# whatever a machine does and reports

MOTION = st.lists(st.tuples(st.integers(1, 30), st.sampled_from([0.0, 0.0, 0.005, 0.02, 0.1, 0.5, -0.3])), max_size=12)
LIE = st.sampled_from(["none", "zeros", "frozen", "stands", "silent", "muted", "late"])


@given(motion=MOTION, stop=st.integers(0, 100), lie=LIE, begin=st.integers(0, 60), jitter=st.integers(0, 3))
def test_what_is_confirmed_stood(motion: list[tuple[int, float]], stop: int, lie: str, begin: int, jitter: int) -> None:
    """Confirmed: the true motion was below the limits for the whole window, for every motion and every report."""
    speeds = [speed for count, speed in motion for _ in range(count)] + [0.0] * 60
    reporter = Reporter(watch())
    proof, angle, stamp, moved = None, 0.0, 0.0, 0.0
    for i, speed in enumerate(speeds):
        reporter.now += PERIOD + 0.002 * (i * jitter % 3)
        angle += speed * PERIOD
        lies = lie != "none" and i >= begin
        moved = moved if lies and lie == "stands" else angle
        stamp = stamp if lies and lie == "frozen" else reporter.now - (0.5 if lies and lie == "late" else 0.0)
        if not (lies and lie == "silent"):
            reported = 0.0 if lies and lie in ("zeros", "stands") else speed
            reporter.publish_now(moved, reported, stamp, arm=not (lies and lie == "muted"))
        if i == stop:
            since = next((100.0 + PERIOD * k for k, one in enumerate(speeds[:i]) if one), None)
            proof = reporter.watch.proof(reporter.now, False, Expected(since))
            stopped = i
        if proof is not None and reporter.watch.proven(proof, reporter.now):
            window = speeds[i - round(0.2 / PERIOD) + 1 : i + 1]
            assert lie == "stands" or all(abs(one) < LIMIT for one in window), (window, lie)
            assert i - stopped >= DEAD / PERIOD
            return


def test_a_joint_below_its_limit_is_told() -> None:
    reporter = Reporter(watch())
    reporter.now += PERIOD
    reporter.publish_now(-3.5, 0.0)
    trouble = reporter.watch.trouble(reporter.now)
    assert trouble is not None and "limit -3.000 rad" in text(trouble.reason, "en")


def test_velocities_are_those_that_are_told() -> None:
    reporter = Reporter(watch())
    reporter.publish_now(0.1, None)
    assert reporter.watch.velocities == {} and reporter.watch.positions == {"boom": 0.1, "arm": 0.1}
    reporter.publish_now(0.2, 0.3, stamp=reporter.now + PERIOD)
    assert reporter.watch.velocities == {"boom": 0.3, "arm": 0.3}


def test_who_publishes_beside_the_driver_is_told() -> None:
    reporter = Reporter(watch())
    reporter.run(1.0, 0.0)
    reporter.watch.published(JOINTS, ("driver", "stranger"))
    trouble = reporter.watch.trouble(reporter.now)
    assert trouble is not None and trouble.reason.find(ManyPublishers) is not None


def test_a_source_that_has_fallen_silent_keeps_a_stop_from_being_proven() -> None:
    reporter = Reporter(watch())
    reporter.run(1.0, 0.0)
    obstacle = reporter.watch.obstacle(reporter.now + 5.0)
    assert obstacle.find(Old) is not None or obstacle.find(OldOf) is not None


def test_velocities_that_are_told_now_and_then_are_compared_with_nothing() -> None:
    reporter = Reporter(watch())
    for i in range(20):
        reporter.now += PERIOD
        reporter.publish_now(0.0, 0.5 if i % 2 else None)
    assert reporter.watch.trouble(reporter.now) is None


def test_an_imu_tells_whether_the_machine_turns() -> None:
    still, source = StillFacts(0.01, 0.02, 0.01, 0.2), SourceFacts(PERIOD, "utc", 2.0, "/zx200/imu")
    made = StandStill(MachineFacts("zx200", {}, {}, still, {IMU: source}))
    for i in range(20):
        made.take(IMU, SourceSample(i * PERIOD, i * PERIOD + 1e9, i, {TURNING: ()}, {TURNING: 0.0}))
    assert not made.moving()
    made.take(IMU, SourceSample(20 * PERIOD, 20 * PERIOD + 1e9, 20, {TURNING: ()}, {TURNING: 0.3}))
    assert made.moving()


def test_a_machine_that_tells_nothing_at_all_has_no_source() -> None:
    made = StandStill(MachineFacts("zx200", {}, {}, StillFacts(0.01, 0.02, 0.01, 0.2), {}))
    assert made.silent(1.0, 1.0) == NoSource() and made.moving()


def test_a_delay_is_learned_anew_after_a_while() -> None:
    """The clock of the machine drifts: after minutes, what was the shortest delay is none any more."""
    reporter = Reporter(watch())
    for _ in range(round(3 * REMEMBERED)):
        reporter.now += 1.0
        reporter.publish_now(0.0, 0.0, stamp=reporter.now * (1 - 1e-5))
    reporter.run(1.0, 0.0)
    assert reporter.watch.trouble(reporter.now) is None


def test_the_way_of_the_base_counts_from_the_mark() -> None:
    reporter = Reporter(watch(odom=True))
    for i in range(50):
        x = 0.02 * i
        reporter.run(PERIOD, 0.0)
        reporter.watch.take(ODOM, SourceSample(
            reporter.now, reporter.now + 1e9, reporter.number, {PLACE: (x, 0.0), HEADING: (0.0,)},
            {PLACE: 0.5, HEADING: 0.0},
        ))  # fmt: skip
        if i == 24:
            reporter.watch.mark()
    assert reporter.watch.travel().way == pytest.approx(0.5)
