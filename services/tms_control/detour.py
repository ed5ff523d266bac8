"""Plans paths of tracks that keep clear of what stands on the ground; where the fastest one is free, that one.

Else it looks for another of the planner's words (planner.py) that is free, at last from poses that a search over a
lattice reaches, and straight into the goal from some metres before or behind it: where machines stand close, there is
no room to turn. A way that was found so is shortened by the words between its poses. The same question has the same
answer.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

from tms_control.ground import Ground, Outline
from tms_control.lattice import Lattice
from tms_control.path import SAME_PLACE, Path, Piece, Pose
from tms_control.planner import Goal, Pace, Plan, passable, plan, words
from tms_control.reasons import InTheWay, NoWayAround
from tms_control.way_check import Contact, WayCheck, needed
from tms_reason.reason import Reason

DOCKS = (0.0, 4.0, -4.0, 8.0, -8.0)  # m before the goal where a way straight into it may begin; negative: behind it
TRIED = 4  # fastest words between two poses that are looked at
NEARER = 0.8  # a goal is tried anew this part nearer to it, ...
FIRST, LONGER = 50, 1.5  # ... and after so many poses, each time that much later
AT_ONCE = 8  # poses of a way that one word may replace


def never() -> bool:
    """That somebody waits for the answer to its end."""
    return False


@dataclass(frozen=True)
class Question:
    """What a way is asked for: from a pose through goals, the last of which has a heading (as planner.plan).

    `arm`: the outline with the arm as it is now. A way that keeps it clear comes first; where there is none, it may be
    over what stands around: heights do not count here, and an arm may be high enough.
    """

    start: Pose
    goals: tuple[Goal, ...]
    pace: Pace
    pivot: float
    outline: Outline
    ground: Ground
    arm: Outline | None = None

    def fastest(self) -> Plan | None:
        """The fastest path of all, if it is free."""
        check = self._check(self.arm or self.outline)
        return None if isinstance(check, Reason) else self._fastest(check)

    def answer(self, over: Callable[[], bool] = never) -> Plan | Reason | None:
        """A free path; or why there is none. It takes up to some seconds.

        `over` is asked again and again whether nobody wants the answer any more; then there is none.
        """
        found = self._answer(self.arm, over) if self.arm is not None else None
        return found if isinstance(found, Plan) or over() else self._answer(self.outline, over)

    def _answer(self, outline: Outline, over: Callable[[], bool]) -> Plan | Reason | None:
        check = self._check(outline)
        if isinstance(check, Reason):
            return check
        if (free := self._fastest(check)) is not None:
            return free
        here, pieces, reached = self.start.ahead(self.pivot), list[Piece](), list[int]()
        for number, goal in enumerate(self.goals):
            before = self.goals[number - 1] if number else self.start
            onward = self.goals[number + 1] if number + 1 < len(self.goals) else None
            targets = [pose.ahead(self.pivot) for pose in passable(before, goal, onward)]
            found = _way(here, targets, self.pace, check, over)
            if over():
                return None
            if found is None:
                return self._blocked(check)
            pieces += found
            reached.append(len(pieces))
            here = pieces[-1].end if pieces else here
        return Plan(Path(tuple(pieces) or (Piece(here, 0.0, 0.0),)), tuple(reached))

    def _fastest(self, check: WayCheck) -> Plan | None:
        found = plan(self.start, self.goals, self.pace, self.pivot)
        return found if check.free(found.path.pieces) else None

    def _check(self, around: Outline) -> WayCheck | Reason:
        last, outline = self.goals[-1], around.seen_from(self.pivot)
        goal = Pose(last.x, last.y, last.yaw or 0.0).ahead(self.pivot)
        least = needed(self.ground, outline, self.start.ahead(self.pivot), goal)
        return least if isinstance(least, Reason) else WayCheck(self.ground, outline, least)

    def _blocked(self, check: WayCheck) -> Reason:
        contact = check.first(plan(self.start, self.goals, self.pace, self.pivot).path.pieces)
        assert contact is not None  # else the fastest path would have been the answer
        return NoWayAround(contact.name, in_the_way(contact))


def in_the_way(contact: Contact) -> Reason:
    """Where something stands on a path."""
    return InTheWay(contact.x, contact.y, contact.away)


def _way(
    start: Pose, targets: Sequence[Pose], pace: Pace, check: WayCheck, over: Callable[[], bool]
) -> list[Piece] | None:
    """The pieces of a free way to one of the targets."""
    connect = _Connect(targets, pace, check)
    if (direct := connect.now(start)) is not None:
        return direct
    found = Lattice(start, targets, check, pace).search(connect.due, connect.now, over)
    if found is None:
        return None
    poses, rest = found
    made = _shortened([*_pieces(poses), *rest], pace, check)
    return made if check.free(made) else None  # turns of the lattice are looked at half way only


class _Connect:
    """Words from a pose into one of the targets, or onto a line into it; now and then while a search goes on."""

    def __init__(self, targets: Sequence[Pose], pace: Pace, check: WayCheck) -> None:
        self._pace, self._check = pace, check
        lines = [Piece(goal.ahead(-away), abs(away), 0.0, 1 if away > 0 else -1) for goal in targets for away in DOCKS]
        self._lines = [line for line in lines if check.free([line])]
        self._nearer, self._waited, self._patience = math.inf, 0, float(FIRST)

    def due(self, away: float) -> bool:
        """Whether to try a pose that is so far [m] from a target."""
        self._waited += 1
        if away > self._nearer and self._waited < self._patience:
            return False
        if self._waited >= self._patience:
            self._patience *= LONGER
        self._nearer, self._waited = min(self._nearer, NEARER * away), 0
        return True

    def now(self, pose: Pose) -> list[Piece] | None:
        """The fastest one that is free."""
        found = [[*word, *([line] if line.length > SAME_PLACE else [])] for line in self._lines
                 for word in _fast(pose, line.start, self._pace)]  # fmt: skip
        return self._check.first_free(sorted(found, key=self._pace.total))


def _fast(start: Pose, goal: Pose, pace: Pace) -> list[list[Piece]]:
    return sorted(words(start, goal), key=pace.total)[:TRIED]


def _pieces(poses: Sequence[Pose]) -> list[Piece]:
    """The lines and turns between poses of a lattice."""
    found = []
    for a, b in pairwise(poses):
        ahead, _ = a.seen(b)
        turned = abs(ahead) <= SAME_PLACE
        found.append(Piece(a, 0.0, a.off(b.yaw)) if turned else Piece(a, abs(ahead), 0.0, 1 if ahead > 0 else -1))
    return found


def _shortened(pieces: Sequence[Piece], pace: Pace, check: WayCheck) -> list[Piece]:
    """The fastest way from pose to pose of one, by the words between poses that follow each other."""
    joined = _joined(pieces)
    poses = [joined[0].start, *(piece.end for piece in joined)]
    best: list[list[Piece]] = [[]]
    for number in range(1, len(poses)):
        ways = [[*best[number - 1], joined[number - 1]]]
        for earlier in range(max(0, number - AT_ONCE), number - 1):
            word = check.first_free(_fast(poses[earlier], poses[number], pace))
            if word is not None:
                ways.append([*best[earlier], *word])
        best.append(min(ways, key=pace.total))
    return best[-1]


def _joined(pieces: Sequence[Piece]) -> list[Piece]:
    """The same with one piece for lines, or turns, that go on as the one before."""
    found = list[Piece]()
    for piece in pieces:
        last = found[-1] if found else None
        if last is not None and piece.direction == last.direction and _same(last, piece):
            found[-1] = Piece(last.start, last.length + piece.length, last.turn + piece.turn, last.direction)
        else:
            found.append(piece)
    return found


def _same(a: Piece, b: Piece) -> bool:
    """Whether both are lines, or turns on the spot to one side."""
    lines = not a.turn and not b.turn
    return lines or (not a.length and not b.length and a.turn * b.turn > 0)
