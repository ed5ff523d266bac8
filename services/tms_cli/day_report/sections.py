"""The tables of a daily report; HTML and PDF show the same ones."""

from collections.abc import Callable
from dataclasses import dataclass

from tms_cli.day_report.facts import Facts
from tms_work.cycle import PARTS
from tms_work.sums import Sum

Row = tuple[str, ...]


@dataclass(frozen=True)
class Section:
    """A table with its title; the first column holds names, the others numbers."""

    title: str
    head: Row
    rows: tuple[Row, ...]


def sections(facts: Facts) -> list[Section]:
    """All tables, in their order; those without rows are left out."""
    by = facts.say("By machine"), facts.say("By hour"), facts.say("By run")
    hours = {facts.say("{hour}:00 to {end}:00", hour=at, end=at + 1): one for at, one in facts.hours.items()}
    found = [
        _plan(facts),
        _sums(facts, by[0], facts.say("Machine"), facts.machines),
        _parts(facts),
        _sums(facts, by[1], facts.say("Hour"), hours),
        _sums(facts, by[2], facts.say("Run"), facts.runs),
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


def _plan(facts: Facts) -> Section:
    """Plan against actual."""
    total, plan = facts.total, facts.plan
    rows = [
        _against(facts.say("Soil dug, bank [m³]"), plan.bank if plan else None, total.bank, 1),
        _against(facts.say("Truck loads"), plan.loads if plan else None, total.loads, 0),
        _against(facts.say("Bank m³ in an hour of an excavator"), None, total.rate, 1),
        _against(facts.say("Soil dug, loose [m³]"), None, total.loose, 1),
        _against(facts.say("Mass [t]"), None, total.mass / 1000, 1),
        _against(facts.say("Soil hauled, loose [m³]"), None, total.hauled, 1),
        _against(facts.say("Distance of carriers [km]"), None, total.distance / 1000, 2),
        _against(facts.say("Cycles of excavators"), None, total.cycles, 0),
        _against(facts.say("Mean cycle [s]"), None, total.mean_cycle, 1),
        _against(facts.say("Mean fill factor"), None, total.fill, 2),
    ]
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


def _parts(facts: Facts) -> Section:
    """Minutes of each part, by machine."""
    rows = []
    for machine, one in facts.machines.items():
        for names, parts in ((PARTS["dig"], one.parts), (PARTS["haul"], one.haul_parts)):
            whole = sum(parts.values())
            for part in names:
                if part in parts:
                    share = f"{100 * parts[part] / whole:.0f} %" if whole else ""
                    name = facts.say("{machine}: {part}", machine=machine, part=part_name(facts, part))
                    rows.append((name, _number(parts[part] / 60, 1), share))
    head = (facts.say("Part"), facts.say("Minutes"), facts.say("Share"))
    return Section(facts.say("Parts of the cycles"), head, tuple(rows))


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
