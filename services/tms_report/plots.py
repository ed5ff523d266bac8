"""Plots of a daily report, by the charts of reportlab: one drawing for the HTML (as SVG) and for the PDF."""

from collections.abc import Sequence
from itertools import accumulate
from typing import Any

from reportlab.graphics.charts.barcharts import HorizontalBarChart, VerticalBarChart
from reportlab.graphics.charts.legends import Legend
from reportlab.graphics.charts.linecharts import HorizontalLineChart
from reportlab.graphics.shapes import Drawing, String
from reportlab.lib.colors import HexColor

from tms_report.facts import Facts
from tms_report.letters import font
from tms_report.sections import part_name
from tms_work.cycle import PARTS

WIDTH, HEIGHT = 480, 170  # points
LEFT, RIGHT, BOTTOM, TOP = 45, 40, 22, 28  # points round a chart
LEGEND = 36  # points
BAR, LINE, PLAN = HexColor(0x92C5DE), HexColor(0x333333), HexColor(0xB2182B)
PART_COLOURS = [HexColor(one) for one in (0x2166AC, 0x67A9CF, 0x1B7837, 0x7FBF7B, 0xF1A340, 0xB2182B)]


def plots(facts: Facts) -> list[Drawing]:
    """All plots of a report; none for a day without work."""
    found = []
    if facts.hours:
        found.append(_hours(facts))
    if any(one.parts for one in facts.machines.values()):
        found.append(_parts(facts))
    return found


def _hours(facts: Facts) -> Drawing:
    """Bank m3 of each hour as bars, by the left axis; their sum and the plan as lines, by the right one."""
    drawing = _drawing(facts.say("Bank m³ by hour: bars, left; sum of the day: black, plan: red, right"))
    names = [str(at) for at in facts.hours]
    amounts = [one.bank for one in facts.hours.values()]
    bars = VerticalBarChart()
    _place(bars, [amounts], names, HEIGHT, max(amounts))
    bars.bars[0].fillColor, bars.bars[0].strokeColor = BAR, None
    drawing.add(bars)
    drawing.add(_lines(facts, names, list(accumulate(amounts))))
    return drawing


def _lines(facts: Facts, names: Sequence[str], sums: list[float]) -> HorizontalLineChart:
    """The sum of the day, and the plan."""
    lines = [sums] if facts.plan is None else [sums, [facts.plan.bank] * len(sums)]
    chart = HorizontalLineChart()
    _place(chart, lines, names, HEIGHT, max(max(line) for line in lines))
    for at, colour in enumerate((LINE, PLAN)[: len(lines)]):
        chart.lines[at].strokeColor, chart.lines[at].strokeWidth = colour, 1.5
    chart.categoryAxis.visible = 0
    axis = chart.valueAxis
    axis.joinAxis, axis.joinAxisMode = chart.categoryAxis, "right"
    axis.tickLeft, axis.tickRight = 0, 5
    axis.labels.boxAnchor, axis.labels.dx = "w", 7
    return chart


def _parts(facts: Facts) -> Drawing:
    """Minutes of each excavator's parts as one bar a machine."""
    machines = {name: one.parts for name, one in facts.machines.items() if one.parts}
    height = 22 * len(machines) + BOTTOM + TOP + LEGEND
    drawing = _drawing(facts.say("Parts of the excavators' cycles, minutes"), height)
    data = [[parts.get(part, 0.0) / 60 for parts in machines.values()] for part in PARTS["dig"]]
    chart = HorizontalBarChart()
    most = max(sum(column) for column in zip(*data, strict=True))
    _place(chart, data, list(machines), height - LEGEND, most)
    chart.y += LEGEND
    chart.categoryAxis.style = "stacked"
    chart.categoryAxis.reverseDirection = 1
    legend = Legend()
    legend.x, legend.y, legend.fontName, legend.fontSize, legend.columnMaximum = LEFT, 22, font(), 7, 2
    legend.alignment, legend.deltax, legend.dxTextSpace, legend.boxAnchor = "right", 130, 3, "w"
    pairs = []
    for at, (part, colour) in enumerate(zip(PARTS["dig"], PART_COLOURS, strict=True)):
        chart.bars[at].fillColor, chart.bars[at].strokeColor = colour, None
        pairs.append((colour, part_name(facts, part)))
    legend.colorNamePairs = pairs
    drawing.add(chart)
    drawing.add(legend)
    return drawing


def _drawing(title: str, height: float = HEIGHT) -> Drawing:
    drawing = Drawing(WIDTH, height)
    drawing.add(String(LEFT, height - 14, title, fontName=font(), fontSize=9))
    return drawing


def _place(chart: Any, data: Sequence[Sequence[float]], names: Sequence[str], height: float, most: float) -> None:
    """Give a chart its place, numbers and axes."""
    chart.x, chart.y, chart.width, chart.height = LEFT, BOTTOM, WIDTH - LEFT - RIGHT, height - BOTTOM - TOP
    chart.data, chart.categoryAxis.categoryNames = [tuple(line) for line in data], list(names)
    chart.valueAxis.valueMin, chart.valueAxis.valueMax = 0, (most or 1.0) * 1.05
    for axis in (chart.categoryAxis, chart.valueAxis):
        axis.labels.fontName, axis.labels.fontSize = font(), 7
