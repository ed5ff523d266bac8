"""What the drill tries and how it counts."""

from tms_cli.drill.report import markdown
from tms_cli.drill.rows import KILL, LEFT_OUT, RESTART, Case, Row, cases, choose, percentile, summary

MOVERS, OTHERS = ["tms:ts", "zx200:rc", "zx200:rp"], ["tms:db", "tms:host", "tms:store"]
SUBTASKS = ["zx200:dig", "zx200:turn", "zx200:dig", "zx200:drop"]


def test_quick_has_twenty_kills_and_full_has_every_pair() -> None:
    quick = cases(MOVERS, SUBTASKS, OTHERS, quick=True)
    assert sum(case.how == KILL for case in quick) >= 20
    full = {(case.process, case.leaf) for case in cases(MOVERS, SUBTASKS, OTHERS, quick=False) if case.how == KILL}
    assert len(full) == 7 * 4


def test_percentiles() -> None:
    assert percentile([], 0.99) is None
    assert percentile([3.0, 1.0, 2.0], 0.5) == 2.0
    assert percentile([float(n) for n in range(1, 101)], 0.99) == 99.0


def test_the_summary_counts_what_matters() -> None:
    good = Row("zx200:rc", "0.0", KILL, "zx200", True, 0.5, 1.2, 0.1, True, 2.0, "goes on")
    slow = Row("zx200:rp", "0.0", RESTART, "zx200", True, 0.9, 1.0, 0.1, True, 2.0, "goes on")
    bad = Row("tms:db", "0.1", KILL, "zx200", False)
    late = Row("tms:db", "0.2", KILL, "zx200", False, outcome=LEFT_OUT)
    found = summary([good, slow, bad, late])
    assert (found["kills"], found["unconfirmed"], found["hung"]) == (2, 1, 1)
    assert found["kill_to_stop_max_s"] == 0.5  # an orderly restart is no kill
    assert found["left_out"] == 1
    assert [row["ok"] for row in found["rows"]] == [True, True, False, False]
    page = markdown([good, bad], found, "demo")
    assert "停止" in page and "| zx200:rc | 0.0 | SIGKILL | 0.500 |" in page


def test_a_case_is_chosen_for_the_leaf_that_runs_and_movers_only_when_the_motion_is_fresh() -> None:
    mover, other = Case("zx200:rc", 1, KILL, True), Case("tms:db", 1, KILL, False)
    todo = [other, mover, Case("zx200:rp", 2, KILL, True)]
    assert choose(todo, 1, fresh=True) == mover
    assert choose(todo, 1, fresh=False) == other
    assert choose(todo, 2, fresh=False) is None
    assert choose(todo, -1, fresh=True) is None
