"""A daily report as one HTML file without any others: tables, plots as SVG, the map as an image inside it."""

import base64
from pathlib import Path
from typing import Any

from lxml import etree, html
from lxml.html import builder as build
from reportlab.graphics import renderSVG

from tms_report.facts import Facts
from tms_report.plots import plots
from tms_report.sections import Section, plan, sections

STYLE = Path(__file__).with_name("page.css")


def render(facts: Facts) -> bytes:
    """The report as UTF-8."""
    title = heading(facts)
    page = build.HTML(
        build.HEAD(build.META(charset="utf-8"), build.TITLE(title), build.STYLE(STYLE.read_text(encoding="utf-8"))),
        build.BODY(build.H1(title), *_parts(facts)),
        lang=facts.language,
    )
    data: bytes = html.tostring(page, doctype="<!DOCTYPE html>", encoding="utf-8")
    return data


def heading(facts: Facts) -> str:
    """The title of a report."""
    return facts.say("Daily report of {site}, {day}", site=facts.site, day=facts.day.isoformat())


def estimate_note(facts: Facts) -> str:
    """Where the volumes come from."""
    total = facts.total
    return facts.say(
        "Volumes: {measured} of {cycles} cycles measured by the machine, the others estimated from its motion.",
        measured=total.measured, cycles=total.cycles,
    )  # fmt: skip


def map_note(facts: Facts) -> str:
    """What the colours of the map mean."""
    if facts.change is None:
        return ""
    return facts.say(
        "From {before} to {after}. Red: lowered, blue: raised, full colour from {full:.2f} m; grey: unknown.",
        before=facts.change.before, after=facts.change.after, full=facts.change.full,
    )  # fmt: skip


def _parts(facts: Facts) -> list[Any]:
    found = []
    if facts.total.cycles == 0 and facts.total.loads == 0:
        found.append(build.P(facts.say("No work is recorded on this day.")))
    found.append(_section(plan(facts)))
    found += [build.E.figure(etree.fromstring(renderSVG.drawToString(plot).encode())) for plot in plots(facts)]
    found += map(_section, sections(facts))
    if facts.change is not None:
        data = "data:image/png;base64," + base64.b64encode(facts.change.picture).decode()
        image = build.IMG(src=data, alt=facts.say("Map of the change of the ground"))
        found.append(build.E.figure(image, build.E.figcaption(map_note(facts))))
    remarks = build.TABLE(build.TR(build.TD()))
    remarks.set("class", "remarks")
    found += [build.P(estimate_note(facts)), build.H2(facts.say("Remarks")), remarks]
    return found


def _section(section: Section) -> Any:
    return build.E.section(build.H2(section.title), _table(section))


def _table(section: Section) -> Any:
    head = build.TR(*(build.TH(word) for word in section.head))
    rows = [build.TR(build.TH(row[0]), *(build.TD(word) for word in row[1:])) for row in section.rows]
    return build.TABLE(head, *rows)
