"""Ages, silence, and what counts as a change."""

from dataclasses import dataclass, field

from tms_msg_ground.msg import SoilLoad

from tms_ur import messages
from tms_ur.board import WAY_LIVES, Board
from tms_ur.models import ActiveRun, Host, Joint, LastStop, Load, Machine, Place, Process
from tms_ur.reason_view import view
from tms_ur.reasons import MachineSilent


@dataclass
class Watched:
    """A board with a clock that the test turns."""

    now: float = 100.0
    changes: int = 0
    board: Board = field(init=False)

    def __post_init__(self) -> None:
        self.board = Board(["zx200", "ic120"], lambda: self.now)
        self.board.on_change(self._changed)

    def _changed(self) -> None:
        self.changes += 1


def machine(angle: float, age: float | None = 0.1) -> Machine:
    joints = [Joint(name="swing_joint", position=angle, velocity=0.0)]
    return Machine(name="zx200", state="standing", joints=joints, joint_age=age)


def test_ages_grow() -> None:
    watched = Watched()
    watched.board.put_machine(machine(1.0))
    watched.board.put_runs([])
    watched.now += 1.5
    state = watched.board.snapshot()
    assert (state.machines[0].age, state.machines[0].joint_age, state.machines[0].state) == (1.5, 1.6, "standing")
    assert (state.scheduler.alive, state.scheduler.age) == (True, 1.5)


def test_silence_is_told_and_heals() -> None:
    watched = Watched()
    watched.board.put_machine(machine(1.0, None))
    watched.board.put_runs([])
    watched.now += 6
    state = watched.board.snapshot()
    assert (state.machines[0].state, state.machines[0].joint_age) == ("silent", None)
    assert state.machines[0].reason == view(MachineSilent("zx200:rc", 6.0))
    assert state.machines[0].joints, "the last angles stay, as old ones"
    assert not state.scheduler.alive
    watched.board.put_machine(machine(1.0))
    assert watched.board.snapshot().machines[0].state == "standing"


def test_only_content_is_a_change() -> None:
    watched = Watched()
    for angle, age, changes in ((1.0, 0.1, 1), (1.0, 0.3, 1), (1.1, 0.1, 2)):
        watched.board.put_machine(machine(angle, age))
        assert watched.changes == changes


def test_first_empty_list_of_runs_is_a_change() -> None:
    watched = Watched()
    run = ActiveRun(run_id="r", task_id=1, state="running")
    for runs, changes in (([], 1), ([], 1), ([run], 2), ([run], 2), ([], 3)):
        watched.board.put_runs(runs)
        assert watched.changes == changes


def test_hosts_stand_side_by_side_and_uptime_goes_on() -> None:
    watched = Watched()
    rows = [Process(name="tms:ts", state="RUNNING", uptime=5.0), Process(name="tms:db", state="STOPPED")]
    watched.board.put_host(Host(name="pc2", processes=rows))
    watched.board.put_host(Host(name="pc1"))
    watched.now += 5
    hosts = watched.board.snapshot().hosts
    assert [host.name for host in hosts] == ["pc1", "pc2"]
    assert [process.uptime for process in hosts[1].processes] == [10.0, 0.0]


def test_the_processes_of_a_silent_pc_are_unknown_until_it_is_heard() -> None:
    watched = Watched()
    host = Host(name="pc1", processes=[Process(name="tms:ts", state="RUNNING", pid=7, uptime=5.0, cpu=3.0, memory=9)])
    watched.board.put_host(host)
    watched.now += 6.1
    reported = watched.board.snapshot().hosts[0]
    assert (reported.age, reported.processes) == (6.1, [Process(name="tms:ts", state="UNKNOWN")])
    assert watched.board.host_of("tms:ts") == "pc1"
    watched.board.put_host(host)
    assert watched.board.snapshot().hosts[0].processes == host.processes


def test_a_place_has_an_age_of_its_own() -> None:
    watched = Watched()
    place = Place(x=1.0, y=2.0, yaw=0.0)
    watched.board.put_place("zx200", place)
    watched.now += 3
    never_received = watched.board.snapshot().machines[0]
    assert (never_received.age, never_received.place, never_received.place_age) == (None, place, 3.0)
    watched.board.put_machine(machine(1.0))
    watched.now += 1
    received = watched.board.snapshot().machines[0]
    assert (received.state, received.place, received.place_age) == ("standing", place, 4.0)
    changes = watched.changes
    watched.board.put_place("zx200", place)
    assert (watched.changes, watched.board.snapshot().machines[0].place_age) == (changes, 0.0)
    assert watched.board.snapshot().machines[1].place_age is None


def test_a_load_is_shown_while_it_is_told() -> None:
    watched = Watched()
    load = messages.load(SoilLoad(mass=1283.4, loose=1.234, bank=1.0, capacity=5.9))
    assert load == Load(mass=1280.0, loose=1.23, capacity=5.9, measured=False)
    for told, changes in ((load, 1), (load, 1), (load.model_copy(update={"loose": 1.24}), 2)):
        watched.board.put_load("zx200", told)
        assert watched.changes == changes
    watched.now += 2.9
    assert watched.board.snapshot().machines[0].load == told
    watched.now += 0.2
    assert watched.board.snapshot().machines[0].load is None


def test_a_way_is_shown_while_its_navigation_tells_it() -> None:
    watched = Watched()
    way = [(0.0, 0.0), (5.0, 1.0)]
    watched.board.put_way("zx200", way)
    changes = watched.changes
    watched.now += WAY_LIVES - 0.1
    watched.board.put_way("zx200", way)
    assert watched.changes == changes
    watched.now += WAY_LIVES - 0.1
    assert watched.board.snapshot().machines[0].way == way
    watched.now += 0.2
    assert watched.board.snapshot().machines[0].way == []


def test_a_machine_tells_since_when_it_is_as_it_is() -> None:
    watched = Watched()
    reasons = [view(MachineSilent("zx200:rc", age)) for age in (1, 2)]
    seen = []
    for state, reason in (("standing", None), ("moving", None), ("not_ready", reasons[0]), ("not_ready", reasons[1])):
        watched.board.put_machine(machine(1.0).model_copy(update={"state": state, "reason": reason}))
        seen.append(watched.board.snapshot().machines[0].since)
    assert None not in seen
    assert seen[0] < seen[1] < seen[2] == seen[3]  # type: ignore[operator]  # a number in a reason is no other state


def test_a_run_tells_since_when_it_waits() -> None:
    watched = Watched()
    run = ActiveRun(run_id="r", task_id=1, state="running")
    seen = []
    for age in (None, 1, 2):
        reason = None if age is None else view(MachineSilent("zx200:rc", age))
        watched.board.put_runs([run.model_copy(update={"reason": reason})])
        seen.append(watched.board.snapshot().runs[0].reason_since)
    assert seen[0] is None
    assert seen[1] == seen[2] is not None


def test_the_last_stop_of_a_machine_stays() -> None:
    watched = Watched()
    stop = LastStop(stamp=None, confirmed=True)
    watched.board.put_stop("zx200", stop)
    assert watched.changes == 1
    watched.board.put_machine(machine(1.0))
    assert [one.last_stop for one in watched.board.snapshot().machines] == [stop, None]
