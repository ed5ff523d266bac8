"""A daily report as PDF (A4), by reportlab: needs no browser and no libraries of the system."""

import io
from typing import Any
from xml.sax.saxutils import escape

from reportlab.lib.colors import HexColor
from reportlab.lib.pagesizes import A4
from reportlab.lib.styles import ParagraphStyle
from reportlab.lib.units import mm
from reportlab.platypus import Image, KeepTogether, Paragraph, SimpleDocTemplate, Spacer, Table, TableStyle

from tms_report.facts import Facts
from tms_report.letters import font
from tms_report.page import estimate_note, heading, map_note
from tms_report.plots import plots
from tms_report.sections import Section, plan, sections

MARGIN = 15 * mm
MAP_WIDTH, MAP_HEIGHT = 165 * mm, 95 * mm
LINES, HEAD = HexColor(0x999999), HexColor(0xEEEEEE)
PADDING = 6  # points that reportlab leaves beside what stands on a page
REMARKS_HEIGHT = 17 * mm


def render(facts: Facts) -> bytes:
    """The report as PDF."""
    out = io.BytesIO()
    title = heading(facts)
    sheet = SimpleDocTemplate(
        out, pagesize=A4, leftMargin=MARGIN, rightMargin=MARGIN, topMargin=MARGIN, bottomMargin=MARGIN, title=title,
        invariant=1,
    )  # fmt: skip
    sheet.build([_text(title, 14), *_parts(facts)])
    return out.getvalue()


def _parts(facts: Facts) -> list[Any]:
    found: list[Any] = []
    if facts.total.cycles == 0 and facts.total.loads == 0:
        found.append(_text(facts.say("No work is recorded on this day.")))
    found.append(_section(plan(facts)))
    found += [KeepTogether([Spacer(1, 4 * mm), plot]) for plot in plots(facts)]
    found += map(_section, sections(facts))
    if facts.change is not None:
        image = Image(io.BytesIO(facts.change.picture), MAP_WIDTH, MAP_HEIGHT, kind="proportional")
        found.append(KeepTogether([Spacer(1, 4 * mm), image, _text(map_note(facts), 8)]))
    remarks = Table([[""]], colWidths=[A4[0] - 2 * MARGIN - 2 * PADDING], rowHeights=[REMARKS_HEIGHT])
    remarks.setStyle(TableStyle([("BOX", (0, 0), (-1, -1), 0.5, LINES)]))
    found += [_text(estimate_note(facts), 8), KeepTogether([_text(facts.say("Remarks"), 11), remarks])]
    return found


def _text(words: str, size: float = 9) -> Paragraph:
    style = ParagraphStyle(
        "text", fontName=font(), fontSize=size, leading=size * 1.4, spaceBefore=size * 0.6, spaceAfter=size * 0.3,
        wordWrap="CJK",
    )  # fmt: skip
    return Paragraph(escape(words), style)


def _section(section: Section) -> KeepTogether:
    return KeepTogether([_text(section.title, 11), _table(section)])


def _table(section: Section) -> Table:
    table = Table([list(section.head), *(list(row) for row in section.rows)], repeatRows=1, hAlign="LEFT")
    table.setStyle(TableStyle([
        ("FONT", (0, 0), (-1, -1), font(), 8),
        ("GRID", (0, 0), (-1, -1), 0.5, LINES),
        ("BACKGROUND", (0, 0), (-1, 0), HEAD),
        ("BACKGROUND", (0, 0), (0, -1), HEAD),
        ("ALIGN", (1, 0), (-1, -1), "RIGHT"),
    ]))  # fmt: skip
    return table
