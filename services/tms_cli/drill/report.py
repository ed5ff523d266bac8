"""The drill's output on a terminal, and its report in Markdown, Japanese and English."""

from collections.abc import Sequence
from datetime import datetime, timezone
from typing import Any

from tms_cli.drill.figures import wrong
from tms_cli.drill.verdict import LEFT_OUT, Row

FACTS = (
    ("trials", "Trials", "試行回数"),
    ("kills", "of them with SIGKILL", "うち強制終了"),
    ("false_receipts", "Confirmed, and truly moving", "停止確認と実際の動きの不一致"),
    ("ran_on", "Moved for longer than it may", "許容時間を超えて動いた回数"),
    ("unconfirmed", "Stops not confirmed", "停止を確認できなかった回数"),
    ("unconfirmed_in_order", "of them with machine and reports in order, one process lost", "うち機械が正常な場合"),
    ("unlatched", "Not confirmed, and not latched", "未確認かつラッチなし"),
    ("disturbed", "Stopped without need", "不要な停止"),
    ("hung", "Runs left hanging", "終わらなかった実行"),
    ("not_back", "Processes that did not come back", "復帰しなかったプロセス"),
    ("left_out", "Trials left out", "未実施"),
    ("void", "Trials that proved nothing, and were made again", "無効(再試行)"),
    ("kill_to_stop_p50_s", "Stop command after a loss, p50 [s]", "停止指令まで 中央値"),
    ("kill_to_stop_p99_s", "Stop command after a loss, p99 [s]", "停止指令まで 99 %"),
    ("kill_to_stop_max_s", "Stop command after a loss, max [s]", "停止指令まで 最大"),
    ("stop_p50_s", "True stand-still, p50 [s]", "実際の停止まで 中央値"),
    ("stop_p99_s", "True stand-still, p99 [s]", "実際の停止まで 99 %"),
    ("back_max_s", "Process back after, max [s]", "復帰まで 最大"),
    ("seed", "Seed", "乱数の種"),
)
STOPS = ("machine", "stop", "trials", "stood_p50_s", "stood_max_s", "joint", "travel_max_rad", "travel_max_m")


def line(row: Row) -> str:
    """One trial as a line of the progress."""
    verdicts = [name for name in ("unconfirmed", "unlatched", "ran_on", "disturbed") if getattr(row, name)]
    if row.false_receipt:
        verdicts.append(f"FALSE RECEIPT: {row.false_receipt}")
    if row.void:
        return f"{row.machine}: {row.stop}, {row.fault}: proves nothing: {row.void}"
    seen = "confirmed" if row.confirmed else ", ".join(verdicts)
    what = ", ".join(dict.fromkeys([*filter(None, [seen]), *verdicts])) or row.outcome
    told = "; ".join([*row.receipts, *filter(None, [row.last_state])])
    reported = f"; hit at {datetime.fromtimestamp(row.at, timezone.utc):%H:%M:%S.%f}: {told}" if verdicts else ""
    return (
        f"{row.machine}: {row.stop}, {row.fault}: {what}; stood after {_text(row.stood_s)} s, "
        f"{row.travel_rad:.3f} rad, {row.travel_m:.2f} m; {row.outcome}{reported}"
    )


def text(figures: dict[str, Any], rows: Sequence[Row]) -> str:
    """The figures for a terminal, and last, where it is found, what must not be."""
    facts = [f"{figures_name(name)}: {_text(figures[name])}" for name, _, _ in FACTS]
    cells = [STOPS, *([_text(one[name]) for name in STOPS] for one in figures["stops"])]
    widths = [max(len(row[column]) for row in cells) for column in range(len(STOPS))]
    table = ["  ".join(word.ljust(width) for word, width in zip(row, widths, strict=True)).rstrip() for row in cells]
    found = [
        f"WRONG: {', '.join(map(figures_name, names))}: {line(row)}"
        for row in rows
        if row.outcome != LEFT_OUT and (names := wrong(row))
    ]
    return "\n".join([*table, "", *facts, *found])


def figures_name(key: str) -> str:
    """The English name of a figure."""
    return next(english for name, english, _ in FACTS if name == key)


def markdown(rows: Sequence[Row], figures: dict[str, Any], site: str) -> str:
    """The report as Markdown."""
    facts = _table(["figure / 項目", "value / 値"], [[f"{e} / {j}", _text(figures[n])] for n, e, j in FACTS])
    stops = _table(list(STOPS), [[_text(one[name]) for name in STOPS] for one in figures["stops"]])
    head = ["machine", "stop", "fault", "told [s]", "stood [s]", "rad", "m", "back [s]", "outcome", "receipts", "wrong"]
    body = _table(head, [_cells(row) for row in rows])
    return (
        f"# Stop drill / 停止訓練: {site}\n\n"
        "Simulated machines were stopped in every way, or what stands behind their motion was lost, while they did or "
        "told the wrong thing. Each receipt was compared with the true motion.\n\n"
        "シミュレーションの機械をあらゆる方法で停止させ、またはその動作を担うプロセスを失わせた。機械には故障や誤った報告も"
        "与え、各停止記録を実際の動きと比較した。\n\n"
        f"{facts}\n\nTime and travel to stand-still, machines in order / 停止までの時間と移動量(機械が正常な場合)\n\n"
        f"{stops}\n\n{body}\n"
    )


def _cells(row: Row) -> list[str]:
    marks = [name for name in ("unlatched", "ran_on", "disturbed") if getattr(row, name)]
    marks += ["unconfirmed"] if row.unconfirmed else []
    marks += [f"void: {row.void}"] if row.void else []
    return [
        row.machine, row.stop, row.fault, _text(row.reported_s), _text(row.stood_s), _text(row.travel_rad),
        _text(row.travel_m), _text(row.back_s), row.outcome, "; ".join(row.receipts).replace("|", "/"),
        ", ".join([*marks, *filter(None, [row.false_receipt])]),
    ]  # fmt: skip


def _table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(row)} |" for row in lines)


def _text(value: Any) -> str:
    if value is None:
        return "-"
    return f"{value:.3f}" if isinstance(value, float) else str(value)
