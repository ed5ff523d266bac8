"""The alarms: rules of deploy/prometheus/rules.yml as pure functions of what tms:ur knows of the site.

A test compares names, durations, severities and numbers with that file. Where Prometheus asks a process for its
metrics, this judges what the process tells everybody: a gateway by its state, a PC by its host agent, the scheduler by
its list of runs. So the console tells the same without Prometheus, and needs no further connection.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from tms_reason.reason import Reason
from tms_ur import reasons
from tms_ur.alarm_models import Severity
from tms_ur.models import Host, Process
from tms_ur.recent import Recent
from tms_ur.state_models import State

MINUTE = 60.0  # s
HOST_SILENT = 6.0  # s, three periods of a host agent; after that its PC may have no power
SCHEDULER, DISCOVERY = "tms:ts", "tms:discovery"
RIVAL = "RIVAL"  # code of a gateway's reason that names another gateway of its machine
UP = "RUNNING"

# Alerts whose facts only the metrics of one process tell: prometheus.py asks Prometheus for them where the site names
# it. Where something of them matters to an operator at once, the process concerned says so itself: a refusal of tms:db,
# the page Data, a run that waits.
NOT_SEEN_HERE: Mapping[str, str] = {
    "TmsSubtaskDown": "only who asks it knows whether it answers; a frozen one is restarted, which counts",
    "TmsTickOverrun": "ticks are counted in the scheduler only",
    "TmsDbSlow": "times of requests are measured in tms:db only",
    "TmsStoreDown": "tms:db tells it to who asks it for something",
    "TmsJournalWaiting": "the journal that waits is on the disk of the scheduler",
    "TmsCyclesWait": "cycles that wait are on the disk of tms:ground",
    "TmsCyclesLost": "counted in tms:ground only",
    "TmsWorkUnseen": "counted in tms:ground only",
    "TmsSoilError": "computed in tms:ground only",
    "TmsClockOffset": "it compares clocks of PCs at the moment of a scrape",
    "TmsClockUnsynchronised": "host agents tell of processes, not of their PC's clock",
    "TmsDiskFilling": "host agents tell of processes, not of their PC's disk",
}


@dataclass(frozen=True)
class Facts:
    """What the rules are judged by."""

    state: State
    now: float  # s, of the clock of `Recent`
    unconfirmed: Recent = field(default_factory=Recent)  # stops by machine
    stood_in: Recent = field(default_factory=Recent)  # losses of a gateway by machine
    standing_in: frozenset[str] = frozenset()  # machines whose host agent commands them now
    restarts: Recent = field(default_factory=Recent)  # by process
    inputs: Mapping[str, str] = field(default_factory=dict)  # states of sensing inputs; empty: nobody tells them


Finding = tuple[str, Reason]  # what it is about, and what is said of it


@dataclass(frozen=True)
class Rule:
    """One alert. `find` gets the facts, and the numbers of the expression in their order, times in s."""

    name: str
    severity: Severity
    lasts: float  # s that it must hold
    numbers: tuple[float, ...]
    find: Callable[..., Iterable[Finding]]


def _unconfirmed(facts: Facts, window: float, most: float) -> Iterator[Finding]:
    for machine in facts.unconfirmed.above(most, facts.now - window):
        yield machine, reasons.StopNotSeen(machine)


def _latched(facts: Facts) -> Iterator[Finding]:
    for machine in facts.state.machines:
        if machine.latch is not None and machine.state != "silent":
            yield machine.name, reasons.LatchHeld(machine.name)


def _unheard(facts: Facts, limit: float) -> Iterator[Finding]:
    for machine in facts.state.machines:
        if machine.state != "silent" and (machine.joint_age is None or machine.joint_age > limit):
            yield machine.name, reasons.NewsOld(machine.name)


def _two_gateways(facts: Facts, most: float) -> Iterator[Finding]:
    for machine in facts.state.machines:
        told = 2 if machine.reason is not None and machine.reason.code == RIVAL else 1
        if told > most:
            yield machine.name, reasons.TwoGateways(machine.name)


def _gateway_lost(facts: Facts, window: float, most: float) -> Iterator[Finding]:
    lost = {*facts.stood_in.above(most, facts.now - window), *facts.standing_in}
    for machine in sorted(lost):
        yield machine, reasons.StoodIn(machine, f"{machine}:rc")


def _down(facts: Facts) -> Iterator[Finding]:
    """Essential processes that do not run, or run and say nothing; of a silent PC only that."""
    away: set[str] = set()
    for host in facts.state.hosts:
        if host.age > HOST_SILENT:
            away |= {process.name for process in host.processes}
            yield host.name, reasons.PcSilent(host.name)
    for process in _processes(facts.state.hosts):
        if process.state not in (UP, "UNKNOWN") and not process.on_demand and process.name != DISCOVERY:
            away.add(process.name)
            yield process.name, reasons.ProcessDown(process.name)
    silent = [f"{machine.name}:rc" for machine in facts.state.machines if machine.state == "silent"]
    for name in [*silent, *([] if facts.state.scheduler.alive else [SCHEDULER])]:
        if name not in away:
            yield name, reasons.NoWord(name)


def _discovery_down(facts: Facts) -> Iterator[Finding]:
    for process in _processes(facts.state.hosts):
        if process.name == DISCOVERY and process.state not in (UP, "UNKNOWN"):
            yield DISCOVERY, reasons.DiscoveryDown(DISCOVERY)


def _not_ready(facts: Facts) -> Iterator[Finding]:
    """Of gateways, which tell it to everybody."""
    for machine in facts.state.machines:
        if machine.state == "not_ready":
            yield f"{machine.name}:rc", reasons.LongUnready(f"{machine.name}:rc")


def _crash_loop(facts: Facts, window: float, least: float) -> Iterator[Finding]:
    looping = set(facts.restarts.above(least - 1, facts.now - window))
    looping |= {process.name for process in _processes(facts.state.hosts) if process.state == "FATAL"}
    for name in sorted(looping):
        yield name, reasons.CrashLoop(name)


def _input_silent(facts: Facts) -> Iterator[Finding]:
    """The limit is that of tms:sp, which calls an input silent; one that never came is not told: a site may lack it."""
    for name, state in facts.inputs.items():
        if state == "silent":
            yield name, reasons.InputQuiet(name)


def _input_clock(facts: Facts) -> Iterator[Finding]:
    for name, state in facts.inputs.items():
        if state == "clock":
            yield name, reasons.SensingClockOff(name)


def _processes(hosts: Iterable[Host]) -> Iterator[Process]:
    return (process for host in hosts for process in host.processes)


RULES = (
    Rule("TmsStopUnconfirmed", "critical", 0, (10 * MINUTE, 0), _unconfirmed),
    Rule("TmsLatchHeld", "warning", 10 * MINUTE, (), _latched),
    Rule("TmsMachineSilent", "critical", 15, (1,), _unheard),
    Rule("TmsTwoGateways", "critical", 0, (1,), _two_gateways),
    Rule("TmsGatewayLost", "critical", 0, (10 * MINUTE, 0), _gateway_lost),
    Rule("TmsProcessDown", "critical", 15, (), _down),
    Rule("TmsDiscoveryDown", "critical", 10, (), _discovery_down),
    Rule("TmsNotReady", "warning", MINUTE, (), _not_ready),
    Rule("TmsCrashLoop", "critical", 0, (10 * MINUTE, 3), _crash_loop),
    Rule("TmsSensingStale", "warning", 5, (), _input_silent),
    Rule("TmsSensingClock", "warning", 30, (), _input_clock),
)
WINDOW = max(number for rule in RULES for number in rule.numbers)  # s that events must be remembered
