"""What the history of a run tells: goals, and the order in which a run was ended."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from datetime import datetime
from typing import Any

Event = dict[str, Any]  # of the console's API
BEGIN = ["run", "node", "stop", "goal"]


def at(event: Event) -> float:
    """s since 1970."""
    return datetime.fromisoformat(event["stamp"]).timestamp()


def ending(events: Sequence[Event]) -> list[Event]:
    """From the decision to end a run to its end."""
    runs = [number for number, event in enumerate(events) if event["kind"] == "run"]
    return list(events[runs[-2] :]) if len(runs) > 1 else []


def wrong_of_cancel(events: Sequence[Event]) -> list[str]:
    """What is wrong with the end of a run.

    Right is: the root's decision, its nodes, the machine's stop, the goal's end (a further stop of the same machine may
    be proven later), and the run is over last.
    """
    kinds = [kind for kind, _ in itertools.groupby(event["kind"] for event in ending(events))]
    right = kinds[:4] == BEGIN and kinds[-1] == "run" and set(kinds[4:-1]) <= {"stop", "goal"}
    return [] if right else [f"the run ended in the order {', '.join(kinds)}"]


def halted_within(events: Sequence[Event]) -> float:
    """From the decision at the root until every node was halted [s]."""
    end = ending(events)
    return max((at(event) for event in end if event["kind"] == "node"), default=at(end[0])) - at(end[0])
