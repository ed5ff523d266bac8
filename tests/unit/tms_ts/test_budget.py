"""A loop that waits for hours leaves little in the history; nodes that work leave everything."""

from tms_ts.budget import MAX_BURST, REFILL_PERIOD, Budget


def test_a_loop_of_hours_is_told_in_part_and_a_leaf_of_seconds_always() -> None:
    now = [0.0]
    budget = Budget(lambda: now[0])
    loop = leaf = 0
    for tick in range(20 * 3600):
        now[0] = tick / 20
        loop += budget.take("0.1")
        if tick % 400 == 0:  # every 20 s
            leaf += budget.take("0.0")
    assert loop <= MAX_BURST + 3600 / REFILL_PERIOD + 1
    assert leaf == 20 * 3600 / 400


def test_a_node_may_change_often_for_a_while() -> None:
    budget = Budget(lambda: 0.0)
    assert sum(budget.take("0") for _ in range(MAX_BURST + 50)) == MAX_BURST
