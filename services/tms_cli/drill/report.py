"""The drill's one-page report, in Markdown, Japanese and English."""

from collections.abc import Sequence
from typing import Any

from tms_cli.drill.rows import Row

HEAD = "| process | node | how | told to stop [s] | stood after [s] | travel [rad] | confirmed | back [s] | outcome |"
RULE = "| --- | --- | --- | --- | --- | --- | --- | --- | --- |"


def line(row: Row) -> str:
    """One trial as a row of the table."""
    parts = [
        row.process, row.node, row.how, _number(row.kill_to_stop_s), _number(row.stop_s), f"{row.travel:.3f}",
        "yes" if row.confirmed else "NO", _number(row.back_s), row.outcome,
    ]  # fmt: skip
    return f"| {' | '.join(parts)} |"


def markdown(rows: Sequence[Row], figures: dict[str, Any], site: str) -> str:
    """The page."""
    hung, unseen = figures["hung"], figures["unconfirmed"]
    facts = [
        ("Kills (SIGKILL) / 強制終了の回数", figures["kills"]),
        ("Trials / 試行回数", figures["trials"]),
        ("Stops not confirmed / 停止を確認できなかった回数", unseen),
        ("Runs left hanging / 終わらなかった実行", hung),
        ("Processes that did not come back / 復帰しなかったプロセス", figures["not_back"]),
        ("Cases left out / 未実施", figures["left_out"]),
        ("Told to stop after, p50 [s] / 停止指令まで 中央値", _number(figures["kill_to_stop_p50_s"])),
        ("Told to stop after, p99 [s] / 停止指令まで 99 %", _number(figures["kill_to_stop_p99_s"])),
        ("Told to stop after, max [s] / 停止指令まで 最大", _number(figures["kill_to_stop_max_s"])),
        ("Stood after the command, p50 [s] / 停止まで 中央値", _number(figures["stop_p50_s"])),
        ("Stood after the command, p99 [s] / 停止まで 99 %", _number(figures["stop_p99_s"])),
        ("Process back after, p50 [s] / 復帰まで 中央値", _number(figures["back_p50_s"])),
        ("Process back after, max [s] / 復帰まで 最大", _number(figures["back_max_s"])),
    ]
    table = "\n".join(f"| {name} | {value} |" for name, value in facts)
    body = "\n".join(line(row) for row in rows)
    return (
        f"# Stop drill / 停止訓練: {site}\n\n"
        "Processes were hit while a simulated machine moved. A process that stands behind the motion must stop the "
        "machine; any other one must not.\n\n"
        "シミュレーションの機械が動いている間に各プロセスを停止させた。動作を担うプロセスでは機械が停止し、"
        "それ以外では動作が続くことを確認する。\n\n"
        f"| figure / 項目 | value / 値 |\n| --- | --- |\n{table}\n\n{HEAD}\n{RULE}\n{body}\n"
    )


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.3f}"
