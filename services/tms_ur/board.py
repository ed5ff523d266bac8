"""The latest state of the site with its age: the ROS thread of site_client.py writes, the web server's thread reads."""

import threading
from collections.abc import Callable, Iterable

from tms_config.clock import monotonic, utc_now
from tms_ur.alarm_keeper import AlarmKeeper
from tms_ur.alarm_models import Alarm
from tms_ur.alarms import HOST_SILENT, Facts
from tms_ur.models import ActiveRun, Host, LastStop, Load, Machine, Place, Process, Question, Scheduler
from tms_ur.place_models import SharedPlaces
from tms_ur.reason_view import view
from tms_ur.reasons import MachineSilent, MachineUnheard
from tms_ur.recent import Recent
from tms_ur.state_models import State
from tms_ur.watch_models import SeenBy, Watched

MACHINE_SILENT = 2.0  # s, four periods of a machine's gateway
SCHEDULER_SILENT = 5.0  # s, five periods of the scheduler's list of runs
WAY_LIVES = 3.0  # s, three periods of a navigation that tells the way that it drives
LOAD_LIVES = 3.0  # s: tms:ground tells loads all the time
INPUTS_LIVE = 3.0  # s, three periods of tms:sp


class Board:
    """Keeps the state for one snapshot and calls listeners when its content, not only an age, has changed."""

    def __init__(self, machines: Iterable[str], clock: Callable[[], float] = monotonic) -> None:
        self._clock = clock
        self._lock = threading.Lock()
        self._machines: dict[str, tuple[Machine, float | None]] = {n: (Machine(name=n), None) for n in machines}
        self._runs: list[ActiveRun] = []
        self._questions: list[Question] = []
        self._places: dict[str, tuple[Place, float]] = {}
        self._ways: dict[str, tuple[list[tuple[float, float]], float]] = {}
        self._loads: dict[str, tuple[Load, float]] = {}
        self._stops: dict[str, LastStop] = {}
        self._shared = SharedPlaces()
        self._watched: dict[str, Watched] = {}
        self._seen: list[SeenBy] = []
        self._runs_at: float | None = None
        self._hosts: dict[str, tuple[Host, float]] = {}
        self._unconfirmed, self._stood_in, self._restarts = Recent(), Recent(), Recent()
        self._standing_in: set[str] = set()
        self._inputs: tuple[dict[str, str], float] | None = None
        self._alarms = AlarmKeeper()
        self._told: list[Alarm] = []  # what Prometheus tells besides
        self._listeners: list[Callable[[], None]] = []
        self.closed = False

    # written by the ROS thread

    def put_machine(self, machine: Machine) -> None:
        """Take a machine's state; `joint_age` is the age that the gateway measured."""
        with self._lock:
            before, _ = self._machines.get(machine.name, (None, None))
            same = before is not None and before.since is not None and _told(before) == _told(machine)
            machine = machine.model_copy(update={"since": before.since if before and same else utc_now()})
            self._machines[machine.name] = (machine, self._clock())
        if before is None or _content(before) != _content(machine):
            self._publish()

    def put_place(self, name: str, place: Place, age: float = 0.0) -> None:
        """Take the place where a machine stood `age` seconds ago."""
        with self._lock:
            before, _ = self._places.get(name, (None, None))
            self._places[name] = (place, self._clock() - age)
        if before != place:
            self._publish()

    def put_way(self, name: str, way: list[tuple[float, float]]) -> None:
        """Take the way that a machine drives, which its navigation tells every second."""
        with self._lock:
            before, _ = self._ways.get(name, (None, None))
            self._ways[name] = (way, self._clock())
        if before != way:
            self._publish()

    def put_load(self, name: str, load: Load) -> None:
        """Take what a machine carries."""
        with self._lock:
            before, _ = self._loads.get(name, (None, None))
            self._loads[name] = (load, self._clock())
        if before != load:
            self._publish()

    def put_stop(self, name: str, stop: LastStop) -> None:
        """Take the last stop of a machine."""
        with self._lock:
            self._stops[name] = stop
            if not stop.confirmed and stop.stamp is not None:
                self._unconfirmed.put(name, self._clock() - (utc_now() - stop.stamp).total_seconds())
        self._publish()

    def put_standing_in(self, name: str, commands: bool) -> None:
        """Take whether a host agent commands a machine in place of its lost gateway."""
        with self._lock:
            if commands and name not in self._standing_in:
                self._stood_in.put(name, self._clock())
            (self._standing_in.add if commands else self._standing_in.discard)(name)
        self._publish()

    def put_told(self, alarms: list[Alarm]) -> None:
        """Take the alarms that Prometheus tells."""
        with self._lock:
            self._told, before = alarms, self._told
        if alarms != before:
            self._publish()

    def put_inputs(self, states: dict[str, str]) -> None:
        """Take the states of all sensing inputs."""
        with self._lock:
            self._inputs = states, self._clock()

    def put_watched(self, name: str, watched: Watched) -> None:
        """Take what a gateway watches besides motion."""
        with self._lock:
            before, self._watched[name] = self._watched.get(name), watched
        if before != watched:
            self._publish()

    def put_seen(self, seen: list[SeenBy]) -> None:
        """Take what all trackers tell."""
        with self._lock:
            before, self._seen = self._seen, seen
        if before != seen:
            self._publish()

    def put_runs(self, runs: list[ActiveRun], questions: list[Question] | None = None) -> None:
        """Take the scheduler's lists, which are complete."""
        asked = questions or []
        with self._lock:
            before = {run.run_id: run for run in self._runs}
            runs = [_waiting_since(run, before.get(run.run_id)) for run in runs]
            changed = runs != self._runs or asked != self._questions or self._runs_at is None
            self._runs, self._questions, self._runs_at = runs, asked, self._clock()
        if changed:
            self._publish()

    def put_shared(self, shared: SharedPlaces) -> None:
        """Take all shared places."""
        with self._lock:
            self._shared = shared
        self._publish()

    def put_host(self, host: Host) -> None:
        """Take all processes of one PC; its agent publishes them at every change, and every 2 s without one."""
        with self._lock:
            before, _ = self._hosts.get(host.name, (host, 0.0))
            for name in restarted(before, host):
                self._restarts.put(name, self._clock())
            self._hosts[host.name] = (host, self._clock())
        self._publish()

    def close(self) -> None:
        """End the updates: listeners close the connections of their clients."""
        self.closed = True
        self._publish()

    def host_of(self, process: str) -> str | None:
        """The PC that a process runs on."""
        with self._lock:
            names = {row.name: pc for pc, (host, _) in self._hosts.items() for row in host.processes}
        return names.get(process)

    # read by the web server

    def on_change(self, listener: Callable[[], None]) -> None:
        """Call `listener` after every change, on the thread that brought it; it must be quick."""
        self._listeners.append(listener)

    def snapshot(self) -> State:
        """The present state."""
        with self._lock:
            now = self._clock()
            state = State(
                time=utc_now(),
                machines=[
                    _aged(machine, now, at, self._places.get(name), self._stops.get(name)).model_copy(
                        update={
                            "watched": self._watched.get(name, Watched()),
                            "way": self._way(name, now),
                            "load": self._load(name, now),
                        }
                    )
                    for name, (machine, at) in self._machines.items()
                ],
                seen=self._seen,
                scheduler=_scheduler(now, self._runs_at),
                runs=self._runs,
                questions=self._questions,
                hosts=[_host(host, now - at) for _, (host, at) in sorted(self._hosts.items())],
                shared=self._shared,
            )
            judged = self._alarms.judge(self._facts(state, now))
            alarms = sorted([*judged, *self._told], key=lambda alarm: alarm.severity != "critical")
            return state.model_copy(update={"alarms": alarms})

    def _facts(self, state: State, now: float) -> Facts:
        inputs, told = self._inputs or ({}, now)
        return Facts(
            state, now, self._unconfirmed, self._stood_in, frozenset(self._standing_in), self._restarts,
            inputs if now - told < INPUTS_LIVE else {},
        )  # fmt: skip

    def _way(self, name: str, now: float) -> list[tuple[float, float]]:
        way, at = self._ways.get(name, ([], now))
        return way if now - at < WAY_LIVES else []

    def _load(self, name: str, now: float) -> Load | None:
        load, at = self._loads.get(name, (None, now))
        return load if now - at < LOAD_LIVES else None

    def _publish(self) -> None:
        for listener in self._listeners:
            listener()


def restarted(before: Host, host: Host) -> list[str]:
    """The processes that a host agent has seen end between two of its messages, once for each time."""
    counted = {process.name: process.restarts for process in before.processes}
    return [
        process.name
        for process in host.processes
        for _ in range(process.restarts - counted.get(process.name, process.restarts))
    ]


def _content(machine: Machine) -> Machine:
    return machine.model_copy(update={"joint_age": None})


def _told(machine: Machine) -> tuple[object, ...]:
    """What must change for a machine to be in another state; numbers in its reasons do not count."""
    reasons = (machine.reason, machine.latch, machine.hold)
    return machine.state, machine.by_hand, *(reason and reason.code for reason in reasons)


def _waiting_since(run: ActiveRun, before: ActiveRun | None) -> ActiveRun:
    if run.reason is None:
        return run
    same = before is not None and before.reason is not None and before.reason.code == run.reason.code
    return run.model_copy(update={"reason_since": before.reason_since if before and same else utc_now()})


def _aged(
    machine: Machine, now: float, at: float | None, place: tuple[Place, float] | None, stop: LastStop | None
) -> Machine:
    update: dict[str, object] = {"last_stop": stop, **_placed(now, place)}
    if at is None:
        return machine.model_copy(update={**update, "reason": view(MachineUnheard(f"{machine.name}:rc"))})
    age = now - at
    joint_age = None if machine.joint_age is None else round(machine.joint_age + age, 1)
    update |= {"age": round(age, 1), "joint_age": joint_age}
    if age > MACHINE_SILENT:
        update |= {"state": "silent", "lamp": "fault", "reason": view(MachineSilent(f"{machine.name}:rc", round(age)))}
    return machine.model_copy(update=update)


def _placed(now: float, place: tuple[Place, float] | None) -> dict[str, object]:
    """The fields of a place. The last one stays, marked as old: a search for the machine begins there."""
    return {} if place is None else {"place": place[0], "place_age": round(now - place[1], 1)}


def _scheduler(now: float, at: float | None) -> Scheduler:
    return Scheduler() if at is None else Scheduler(alive=now - at < SCHEDULER_SILENT, age=round(now - at, 1))


def _host(host: Host, age: float) -> Host:
    shown = _unknown if age > HOST_SILENT else _running
    processes = [shown(process, age) for process in host.processes]
    return host.model_copy(update={"age": round(age, 1), "processes": processes})


def _running(process: Process, age: float) -> Process:
    if process.state != "RUNNING":
        return process
    return process.model_copy(update={"uptime": round(process.uptime + age, 1)})


def _unknown(process: Process, _: float) -> Process:
    return process.model_copy(update={"state": "UNKNOWN", "pid": 0, "uptime": 0.0, "cpu": 0.0, "memory": 0})
