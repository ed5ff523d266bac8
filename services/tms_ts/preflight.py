"""Finds errors of a run before it starts. Pure logic."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

from tms_config.config import Site
from tms_config.reasons import NoMachine
from tms_machine.goal_inputs import Inputs, parted
from tms_reason.reason import Reason
from tms_ts.bt import Tree
from tms_ts.bt.errors import did_you_mean, short, within
from tms_ts.bt.tree import LeafGoal, SharedValue
from tms_ts.nodes.machine_leaf import ROS_NAME
from tms_ts.reasons import (
    BadSubtaskName,
    InputSilent,
    KnownAtRun,
    MotionRefused,
    MotionRefusedNow,
    NobodyWrites,
    NoRecord,
    NoRecordNear,
    NoSharedField,
    NoSharedRecord,
    NotOffered,
    RecordAgeUnknown,
    RecordOld,
    RecordUnfit,
    ServedElsewhere,
    SharedStatic,
)
from tms_ts.tree_reasons import Line, NotPlain, NumberTooBig, Placed


@dataclass
class Findings:
    """Errors refuse a run, warnings are shown."""

    errors: list[Reason] = field(default_factory=list)
    warnings: list[Reason] = field(default_factory=list)


def machines_of(tree: Tree) -> list[str]:
    """Machines that a tree will move, in document order; names that are known only during the run are left out."""
    return list(dict.fromkeys(goal.machine for goal in tree.leaf_goals() if "{" not in goal.machine))


def records_of(tree: Tree) -> list[str]:
    """Records that a tree names, as MODEL/RECORD; MODEL/* where the record is known only during the run."""
    shared = [(value.record, "") for value in tree.shared_values()]
    goals = [(name, goal.machine) for goal in tree.leaf_goals() if "{" not in goal.machine for name in _named(goal)]
    names = [f"{model}/{'*' if '{' in record else record}" for record, model in [*goals, *shared] if record]
    return list(dict.fromkeys(names))


def _named(goal: LeafGoal) -> list[str]:
    """The records of a goal: its own, one or several, and the one whose plan it goes on from."""
    record, inputs = parted(goal.record)
    return [*_each(record), str(inputs.get("previous_target_record_name", ""))]


def _each(record: str) -> list[str]:
    """The names in one, comma between: plans of several records are executed as one trajectory."""
    return [name.strip() for name in record.split(",")]


def processes_of(tree: Tree, site: Site) -> list[str]:
    """Processes that a tree needs, of the machines of this site."""
    goals = [goal for goal in tree.leaf_goals() if goal.machine in site.file.machines]
    return list(dict.fromkeys(f"{goal.machine}:{goal.subtask}" for goal in goals if "{" not in goal.subtask))


Values = Mapping[str, Any]


@dataclass(frozen=True)
class StoredRecord:
    """A record as the database has it."""

    values: Values
    type: str = "static"
    age: float | None = None  # s; None: unknown
    max_age: float = 0.0  # s; 0: it never gets too old


@dataclass(frozen=True)
class Refusal:
    """Why a planner would refuse a goal; `lasting`: for the machine's limits or its own body."""

    why: Reason
    lasting: bool


class Surroundings(Protocol):
    """What preflight asks about the system around a tree."""

    def record(self, machine: str, record: str) -> StoredRecord | None: ...

    def names(self, machine: str) -> list[str]: ...  # of its records

    def served(self, machine: str, subtask: str) -> bool: ...  # whether another system serves its action

    def misread(self, machine: str, subtask: str) -> Reason | None: ...  # why a goal to that server would be misread

    def problem(self, machine: str) -> Reason | None: ...  # why the machine could not move now

    def written(self, record: str, field: str) -> bool: ...  # whether an active run or sensing writes a shared value

    def silent(self, machine: str, record: str) -> str: ...  # the sensing input that should write it and does not

    def unfit(self, machine: str, subtask: str, values: Values, inputs: Inputs) -> Reason | None: ...  # why not usable

    def oldest(self, machine: str, subtask: str) -> float: ...  # s that a subtask lets its record be old; 0: as it says

    def refusal(self, machine: str, subtask: str, record: str, inputs: Inputs) -> Refusal | None: ...  # in this order

    def unplanned(self) -> list[Reason]: ...  # why the planners were not asked about some of the goals


def preflight(tree: Tree, site: Site, around: Surroundings) -> Findings:
    """Check every leaf of a tree against the site, the database and the running processes."""
    found = Findings([fault.reason for fault in tree.faults], [at(line, what) for line, what in tree.warnings])
    for goal in tree.leaf_goals():
        _check_goal(found, goal, site, around)
    _check_shared(found, tree.shared_values(), around)
    for machine in machines_of(tree):
        problem = around.problem(machine) if machine in site.file.machines else None
        if problem is not None:
            found.warnings.append(problem)
    found.warnings += around.unplanned()
    return Findings(list(dict.fromkeys(found.errors)), list(dict.fromkeys(found.warnings)))


def at(line: int, what: Reason) -> Reason:
    """A reason with the line of the task."""
    return Placed(Line(line), what)


def _at_leaf(leaf: LeafGoal | SharedValue, what: Reason) -> Reason:
    return at(leaf.line, within(leaf.template, what))


def _check_goal(found: Findings, goal: LeafGoal, site: Site, around: Surroundings) -> None:
    if "{" not in goal.machine and goal.machine not in site.file.machines:
        found.errors.append(_at_leaf(goal, NoMachine(goal.machine, tuple(site.file.machines))))
        return
    if "{" in goal.machine or "{" in goal.subtask:
        found.warnings.append(_at_leaf(goal, KnownAtRun()))
        return
    if not goal.subtask:
        return  # a fault of the node
    if not ROS_NAME.fullmatch(goal.subtask):
        found.errors.append(_at_leaf(goal, BadSubtaskName(short(goal.subtask, 100))))
        return
    offered = site.model_of(goal.machine).subtasks
    if goal.subtask not in offered and around.served(goal.machine, goal.subtask):
        found.warnings.append(_at_leaf(goal, ServedElsewhere(goal.subtask, goal.machine)))
        if (why := around.misread(goal.machine, goal.subtask)) is not None:
            found.errors.append(_at_leaf(goal, why))
    elif goal.subtask not in offered:
        found.errors.append(_at_leaf(goal, NotOffered(goal.machine, goal.subtask, tuple(offered))))
    else:
        record, inputs = parted(goal.record)
        wrong = len(found.errors)
        for one in _each(record):
            if "{" not in one:
                _check_record(found, goal, one, inputs, around)
        if len(found.errors) == wrong and "{" not in goal.record:
            _check_motion(found, goal, record, inputs, around)


def _check_motion(found: Findings, goal: LeafGoal, record: str, inputs: Inputs, around: Surroundings) -> None:
    """Plan a goal from the pose that the goals before it, in the document, leave the arm in."""
    refusal = around.refusal(goal.machine, goal.subtask, record, inputs)
    if refusal is None:
        return
    stored = [around.record(goal.machine, one) for one in _each(record)]
    name = f"{goal.machine}/{record}"
    if refusal.lasting and all(one is not None and one.type == "static" for one in stored):
        found.errors.append(_at_leaf(goal, MotionRefused(name, goal.subtask, refusal.why)))
    else:
        found.warnings.append(_at_leaf(goal, MotionRefusedNow(name, goal.subtask, refusal.why)))


def _check_record(found: Findings, goal: LeafGoal, record: str, inputs: Inputs, around: Surroundings) -> None:
    name, stored = f"{goal.machine}/{record}", around.record(goal.machine, record)
    if stored is None:
        near = did_you_mean(record, around.names(goal.machine))
        found.errors.append(_at_leaf(goal, NoRecord(name) if near is None else NoRecordNear(name, near)))
        return
    known = {port: value for port, value in inputs.items() if "{" not in str(value)}
    unfit = around.unfit(goal.machine, goal.subtask, stored.values, known)
    if unfit is not None:
        found.errors.append(_at_leaf(goal, RecordUnfit(name, goal.subtask, unfit)))
    limit = around.oldest(goal.machine, goal.subtask) or stored.max_age
    if limit > 0 and stored.type != "static" and (stored.age is None or stored.age > limit):
        old = RecordAgeUnknown(name, limit) if stored.age is None else RecordOld(name, stored.age, limit)
        found.warnings.append(_at_leaf(goal, old))
    silent = around.silent(goal.machine, record)
    if silent:
        found.warnings.append(_at_leaf(goal, InputSilent(silent, name)))


def _check_shared(found: Findings, values: list[SharedValue], around: Surroundings) -> None:
    own = {(value.record, value.field) for value in values if value.writes}
    for value in values:
        if "{" in value.record + value.field:
            continue
        stored = around.record("", value.record)
        if stored is None:
            found.warnings.append(_at_leaf(value, NoSharedRecord(value.record)))
        elif not value.writes and value.field not in stored.values:
            found.warnings.append(_at_leaf(value, NoSharedField(value.record, value.field)))
        elif not value.writes and (note := _unread(value, stored.values[value.field])) is not None:
            found.warnings.append(_at_leaf(value, note))
        elif value.writes and stored.type == "static":
            found.warnings.append(_at_leaf(value, SharedStatic(value.record)))
        elif value.looped and not value.writes and (value.record, value.field) not in own:
            if not around.written(value.record, value.field):
                found.warnings.append(_at_leaf(value, NobodyWrites(value.field, value.record)))


def _unread(value: SharedValue, stored: Any) -> Reason | None:
    """What is not read of a stored value, here or in the C++ system."""
    if isinstance(stored, list):
        return NotPlain(value.record, value.field)
    large = isinstance(stored, int) and not -(2**31) <= stored < 2**31
    return NumberTooBig(f"{value.record}.{value.field}") if large else None
