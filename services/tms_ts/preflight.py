"""What can be known to go wrong before a run starts. Pure logic."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

from tms_config.config import Site
from tms_ts.bt import Tree
from tms_ts.bt.errors import did_you_mean, short
from tms_ts.bt.tree import LeafGoal, SharedValue
from tms_ts.nodes.leaf_node import ROS_NAME


@dataclass
class Findings:
    """Errors refuse a run, warnings are shown; each is one line."""

    errors: list[str] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)


def machines_of(tree: Tree) -> list[str]:
    """Machines that a tree will move, in document order; names that only the run decides are left out."""
    return list(dict.fromkeys(goal.machine for goal in tree.leaf_goals() if "{" not in goal.machine))


def records_of(tree: Tree) -> list[str]:
    """Records that a tree names, as MODEL/RECORD; MODEL/* where only the run decides which."""
    shared = [(value.record, "") for value in tree.shared_values()]
    goals = [(goal.record, goal.machine) for goal in tree.leaf_goals() if "{" not in goal.machine]
    names = [f"{model}/{'*' if '{' in record else record}" for record, model in [*goals, *shared] if record]
    return list(dict.fromkeys(names))


def processes_of(tree: Tree, site: Site) -> list[str]:
    """Processes that a tree needs, of the machines of this site."""
    goals = [goal for goal in tree.leaf_goals() if goal.machine in site.file.machines]
    return list(dict.fromkeys(f"{goal.machine}:{goal.subtask}" for goal in goals if "{" not in goal.subtask))


Values = Mapping[str, Any]


@dataclass(frozen=True)
class Stored:
    """A record as the database has it."""

    values: Values
    type: str = "static"
    age: float | None = None  # s; None: nobody knows
    max_age: float = 0.0  # s; 0: it never gets too old


class Surroundings(Protocol):
    """What a tree meets outside."""

    def record(self, machine: str, record: str) -> Stored | None: ...

    def names(self, machine: str) -> list[str]: ...  # of its records

    def served(self, machine: str, subtask: str) -> bool: ...  # whether another system has an action server for it

    def problem(self, machine: str) -> str: ...  # why it could not move now, or ""

    def written(self, record: str, field: str) -> bool: ...  # whether an active run or sensing writes a shared value

    def silent(self, machine: str, record: str) -> str: ...  # the sensing input that should write it and does not

    def unfit(self, machine: str, subtask: str, values: Values) -> str: ...  # why a subtask cannot use the values

    def oldest(self, machine: str, subtask: str) -> float: ...  # s that a subtask lets its record be old; 0: as it says


def preflight(tree: Tree, site: Site, around: Surroundings) -> Findings:
    """Check every leaf of a tree against the site, the database and what else runs."""
    found = Findings(warnings=[f"line {line}: {text}" for line, text in tree.warnings])
    for goal in tree.leaf_goals():
        _check_goal(found, goal, site, around)
    _check_shared(found, tree.shared_values(), around)
    for machine in machines_of(tree):
        problem = around.problem(machine) if machine in site.file.machines else ""
        if problem:
            found.warnings.append(problem)
    return Findings(list(dict.fromkeys(found.errors)), list(dict.fromkeys(found.warnings)))


def _check_goal(found: Findings, goal: LeafGoal, site: Site, around: Surroundings) -> None:
    where = f"line {goal.line}"
    if "{" not in goal.machine and goal.machine not in site.file.machines:
        known = ", ".join(site.file.machines) or "none"
        found.errors.append(f"{where}: the site has no machine '{goal.machine}' (there: {known})")
        return
    if "{" in goal.machine or "{" in goal.subtask:
        found.warnings.append(f"{where}: machine or subtask is known only when the leaf starts")
        return
    if not ROS_NAME.fullmatch(goal.subtask):
        name = short(goal.subtask, 100)
        text = f"subtask_name={name!r} can be no ROS name: at most 200 letters, digits and _, no blanks"
        found.errors.append(f"{where}: {text}")
        return
    offered = site.model_of(goal.machine).subtasks
    if goal.subtask not in offered and around.served(goal.machine, goal.subtask):
        text = f"'{goal.subtask}' of {goal.machine} is served by another system: its record is not checked"
        found.warnings.append(f"{where}: {text}")
    elif goal.subtask not in offered:
        found.errors.append(f"{where}: {goal.machine} offers no '{goal.subtask}' (there: {', '.join(offered)})")
    elif "{" not in goal.record:
        _check_record(found, goal, around)


def _check_record(found: Findings, goal: LeafGoal, around: Surroundings) -> None:
    where, name = f"line {goal.line}", f"{goal.machine}/{goal.record}"
    stored = around.record(goal.machine, goal.record)
    if stored is None:
        near = did_you_mean(goal.record, around.names(goal.machine))
        hint = f"{near}; or add it" if near else "add it"
        command = f"`tms param set {name} --create FIELD=VALUE`"
        found.errors.append(f"{where}: no record {name}; {hint} with {command} or on the console's page Data")
        return
    unfit = around.unfit(goal.machine, goal.subtask, stored.values)
    if unfit:
        text = f"record {name} does not fit {goal.subtask}: {unfit}; correct it with `tms param set`"
        found.errors.append(f"{where}: {text}")
    limit = around.oldest(goal.machine, goal.subtask) or stored.max_age
    if limit > 0 and stored.type != "static" and (stored.age is None or stored.age > limit):
        old = "of unknown age" if stored.age is None else f"{stored.age:.0f} s old"
        text = f"record {name} is {old}, allowed are {limit:g} s: the leaf fails unless sensing writes it"
        found.warnings.append(f"{where}: {text}")
    silent = around.silent(goal.machine, goal.record)
    if silent:
        found.warnings.append(f"{where}: sensing input {silent} should write record {name} and is silent")


def _check_shared(found: Findings, values: list[SharedValue], around: Surroundings) -> None:
    own = {(value.record, value.field) for value in values if value.writes}
    for value in values:
        if "{" in value.record + value.field:
            continue
        where = f"line {value.line}"
        stored = around.record("", value.record)
        if stored is None:
            text = f"no shared record {value.record}; add it with `tms param set /{value.record} --create FIELD=VALUE`"
            found.warnings.append(f"{where}: {text}")
        elif not value.writes and value.field not in stored.values:
            found.warnings.append(f"{where}: shared record {value.record} has no field '{value.field}'")
        elif value.writes and stored.type == "static":
            found.warnings.append(f"{where}: shared record {value.record} is static: a run must not write it")
        elif value.looped and not value.writes and (value.record, value.field) not in own:
            if not around.written(value.record, value.field):
                text = (
                    f"no active task and no sensing input writes {value.field} of {value.record}, which is waited for"
                )
                found.warnings.append(f"{where}: {text}")
