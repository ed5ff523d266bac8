"""The tables of a daily report; HTML and PDF show the same ones."""

from collections.abc import Callable
from dataclasses import dataclass

from tms_report.facts import Facts
from tms_work.cycle import PARTS, Kind
from tms_work.sums import Sum

Row = tuple[str, ...]


@dataclass(frozen=True)
class Section:
    """A table with its title; the first column holds names, the others numbers."""

    title: str
    head: Row
    rows: tuple[Row, ...]


def sections(facts: Facts) -> list[Section]:
    """All tables but that of the plan, in their order; those without rows are left out."""
    by = facts.say("By hour"), facts.say("By run")
    hours = {facts.say("{hour}:00 to {end}:00", hour=at, end=at + 1): one for at, one in facts.hours.items()}
    found = [
        _excavators(facts),
        _parts(facts, facts.say("Time of the excavators [min]"), "dig", lambda one: one.parts),
        _carriers(facts),
        _parts(facts, facts.say("Time of the carriers [min]"), "haul", lambda one: one.haul_parts),
        _sums(facts, by[0], facts.say("Hour"), hours),
        _sums(facts, by[1], facts.say("Run"), facts.runs),
        _ground(facts),
    ]
    return [one for one in found if one.rows]


def part_name(facts: Facts, part: str) -> str:
    """The name of a part of a cycle."""
    names: dict[str, Callable[[], str]] = {
        "dig": lambda: facts.say("digging"), "swing_loaded": lambda: facts.say("swinging loaded"),
        "dump": lambda: facts.say("dumping"), "swing_back": lambda: facts.say("swinging back"),
        "wait_for_truck": lambda: facts.say("waiting for a truck"), "stopped": lambda: facts.say("stopped"),
        "load": lambda: facts.say("being loaded"), "haul": lambda: facts.say("hauling"),
        "tip": lambda: facts.say("tipping"), "return": lambda: facts.say("driving back"),
        "wait": lambda: facts.say("waiting"),
    }  # fmt: skip
    return names[part]()


def plan(facts: Facts) -> Section:
    """Plan against actual."""
    total, planned = facts.total, facts.plan
    rows = [
        _against(facts.say("Soil dug, bank [m³]"), planned.bank if planned else None, total.bank, 1),
        _against(facts.say("Truck loads"), planned.loads if planned else None, total.loads, 0),
        _against(facts.say("Bank m³ in an hour of an excavator"), None, total.rate, 1),
        _against(facts.say("Soil dug, loose [m³]"), None, total.loose, 1),
        _against(facts.say("Mass [t]"), None, total.mass / 1000, 1),
        _against(facts.say("Soil hauled, loose [m³]"), None, total.hauled, 1),
        _against(facts.say("Distance of carriers [km]"), None, total.distance / 1000, 2),
        _against(facts.say("Cycles of excavators"), None, total.cycles, 0),
        _against(facts.say("Mean cycle [s]"), None, total.mean_cycle, 1),
        _against(facts.say("Mean fill factor"), None, total.fill, 2),
    ]
    if total.unseen:
        rows.append(_against(facts.say("Machine time that nobody saw [min]"), None, total.unseen / 60, 1))
    head = ("", facts.say("Plan"), facts.say("Actual"), facts.say("Share"))
    return Section(facts.say("Plan against actual"), head, tuple(rows))


def _against(name: str, plan: float | None, actual: float | None, digits: int) -> Row:
    share = f"{100 * actual / plan:.0f} %" if plan and actual is not None else ""
    return name, _number(plan, digits), _number(actual, digits), share


def _sums(facts: Facts, title: str, first: str, groups: dict[str, Sum]) -> Section:
    head = (
        first, facts.say("Cycles"), facts.say("Bank m³"), facts.say("Loose m³"), "t", facts.say("Fill factor"),
        facts.say("Loads"), "km", facts.say("Bank m³/h"),
    )  # fmt: skip
    rows = tuple(
        (
            name, str(one.cycles), _number(one.bank, 1), _number(one.loose, 1), _number(one.mass / 1000, 1),
            _number(one.fill, 2), str(one.loads), _number(one.distance / 1000, 2), _number(one.rate, 1),
        )
        for name, one in groups.items()
    )  # fmt: skip
    return Section(title, head, rows)


def _excavators(facts: Facts) -> Section:
    head = (
        facts.say("Machine"), facts.say("Cycles"), facts.say("Bank m³"), facts.say("Loose m³"), "t",
        facts.say("Fill factor"), facts.say("Bank m³/h"), facts.say("Mean cycle [s]"),
    )  # fmt: skip
    rows = tuple(
        (
            name, str(one.cycles), _number(one.bank, 1), _number(one.loose, 1), _number(one.mass / 1000, 1),
            _number(one.fill, 2), _number(one.rate, 1), _number(one.mean_cycle, 1),
        )
        for name, one in facts.machines.items() if one.cycles
    )  # fmt: skip
    return Section(facts.say("Excavators"), head, rows)


def _carriers(facts: Facts) -> Section:
    head = (
        facts.say("Machine"), facts.say("Loads"), facts.say("Hauled, loose m³"), facts.say("Loose m³ a load"), "km",
    )  # fmt: skip
    rows = tuple(
        (
            name, str(one.loads), _number(one.hauled, 1), _number(one.hauled / one.loads if one.loads else None, 1),
            _number(one.distance / 1000, 2),
        )
        for name, one in facts.machines.items() if one.haul_parts or one.loads
    )  # fmt: skip
    return Section(facts.say("Carriers"), head, rows)


def _parts(facts: Facts, title: str, kind: Kind, parts: Callable[[Sum], dict[str, float]]) -> Section:
    """Minutes of each part, and its share, by machine."""
    found = {name: parts(one) for name, one in facts.machines.items() if parts(one)}
    rows = tuple((name, *(_share(one, part) for part in PARTS[kind])) for name, one in found.items())
    return Section(title, (facts.say("Machine"), *(part_name(facts, part) for part in PARTS[kind])), rows)


def _share(parts: dict[str, float], part: str) -> str:
    whole = sum(parts.values())
    if part not in parts or not whole:
        return ""
    return f"{parts[part] / 60:.1f} ({100 * parts[part] / whole:.0f} %)"


def _ground(facts: Facts) -> Section:
    """Volumes of the change of the ground."""
    title, head = facts.say("Change of the ground"), ("", "m³", facts.say("at most, m³"))
    if facts.change is None:
        return Section(title, head, ())
    found = facts.change.volumes
    cut = (facts.say("Cut"), _number(found.cut, 1), _number(found.cut_at_most, 1))
    fill = (facts.say("Fill"), _number(found.fill, 1), _number(found.fill_at_most, 1))
    return Section(title, head, (cut, fill))


def _number(value: float | None, digits: int) -> str:
    return "" if value is None else f"{value:.{digits}f}"
