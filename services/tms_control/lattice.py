"""A search over places a metre apart and 16 headings: the lattice of poses of a machine on tracks.

From a pose it goes on to the next place along its heading, forward or in reverse, or turns on the spot to the heading
beside. A* with a weight (I. Pohl, 1970) finds a way of which the time is at most that part longer than the shortest.
"""

import heapq
import math
from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from typing import TypeVar

import numpy as np

from tms_control.ground import Array
from tms_control.path import Pose
from tms_control.planner import Pace
from tms_control.way_check import WayCheck

CELL = 1.0  # m between places
# Steps of the headings, in cells: whole ones, so that no way leaves the lattice.
STEPS = ((1, 0), (2, 1), (1, 1), (1, 2), (0, 1), (-1, 2), (-1, 1), (-2, 1),
         (-1, 0), (-2, -1), (-1, -1), (-1, -2), (0, -1), (1, -2), (1, -1), (2, -1))  # fmt: skip
COUNT = len(STEPS)
BORDER = 2  # cells around it that nothing enters: no step is longer
AROUND = 40.0  # m around start and goals that a way may lead through
MOST_CELLS = 200_000  # places; a lattice of more is not searched
ITERATIONS = 40_000  # poses that are looked at: half a second
WEIGHT = 1.3
AT_ONCE = 300  # cells that are looked at together, in all headings: a tenth of a second for bodies of 50 corners

T = TypeVar("T")


class Lattice:
    """The lattice of one start."""

    def __init__(self, start: Pose, goals: Sequence[Pose], check: WayCheck, pace: Pace) -> None:
        self._start, self._goals, self._check, self._pace = start, goals, check, pace
        seen = np.array([(0.0, 0.0), *(start.seen(goal) for goal in goals)])
        low, high = (np.floor((edge + side * AROUND) / CELL).astype(int) for edge, side in
                     ((seen.min(axis=0), -1), (seen.max(axis=0), 1)))  # fmt: skip
        self._low = [int(one) - BORDER for one in low]
        self._columns, self._rows = (int(one) for one in high - low + 2 * BORDER + 1)
        self._cells = self._columns * self._rows
        self._yaws = [math.atan2(y, x) for x, y in STEPS]

    def search(
        self, due: Callable[[float], bool], connect: Callable[[Pose], T | None], over: Callable[[], bool]
    ) -> tuple[list[Pose], T] | None:
        """Poses from the start to one that `connect` brings to a goal, and what that returned; None: no way.

        `due` gets how far [m] a pose is from the nearest goal, and says whether that is to be tried; `over`, whether
        nobody wants the way any more.
        """
        if self._cells > MOST_CELLS:
            return None
        free, hopes = self._free(over), self._hopes()
        begin = self._number(0, 0)
        cost, before, done = {begin: 0.0}, {begin: begin}, set[int]()
        heap = [(0.0, begin)]
        for _ in range(ITERATIONS):
            if over() or not heap:
                return None
            _, state = heapq.heappop(heap)
            if state in done:
                continue
            done.add(state)
            away = hopes[state % self._cells] * self._pace.forward
            if due(away) and (found := connect(self._pose(state))) is not None:
                return self._back(state, before), found
            for after, seconds in self._steps(state, free):
                total = cost[state] + seconds
                if total < cost.get(after, math.inf):
                    cost[after], before[after] = total, state
                    heapq.heappush(heap, (total + WEIGHT * hopes[after % self._cells], after))
        return None

    def _steps(self, state: int, free: bytes) -> Iterator[tuple[int, float]]:
        """The poses that are reached from one, and how long that takes [s]."""
        heading, cell = divmod(state, self._cells)
        x, y = STEPS[heading]
        way, length = y * self._columns + x, CELL * math.hypot(x, y)
        for direction in (1, -1):
            after = cell + direction * way
            if free[2 * heading * self._cells + after]:
                yield heading * self._cells + after, length / self._pace.speed(direction)
        for other, between in (((heading + 1) % COUNT, heading), ((heading - 1) % COUNT, (heading - 1) % COUNT)):
            if free[(2 * between + 1) * self._cells + cell] and free[2 * other * self._cells + cell]:
                angle = abs(math.remainder(self._yaws[other] - self._yaws[heading], math.tau))
                yield other * self._cells + cell, angle / self._pace.turn

    def _free(self, over: Callable[[], bool]) -> bytes:
        """Whether each cell is free, in each heading and half way to the next: 2 x headings x cells."""
        free = np.zeros((2 * COUNT, self._rows, self._columns), dtype=bool)
        free[:, BORDER:-BORDER, BORDER:-BORDER] = True
        flat, places = free.reshape(2 * COUNT, self._cells), self._places()
        yaws = self._start.yaw + np.array([yaw + part for yaw, after in pairwise([*self._yaws, self._yaws[0]])
                                           for part in (0.0, math.remainder(after - yaw, math.tau) / 2)])  # fmt: skip
        for taken, cells, check in self._check.near(places):
            flat[:, taken] = False
            for part in np.array_split(cells, 1 + len(cells) // AT_ONCE):
                if over():  # then what is free matters no more
                    return b""
                poses = np.column_stack([np.tile(places[part], (len(yaws), 1)), np.repeat(yaws, len(part))])
                flat[:, part] &= ~check.taken(poses).reshape(len(yaws), len(part))
        return flat.tobytes()

    def _places(self) -> Array:
        """All cells in the map: cells x 2."""
        y, x = np.divmod(np.arange(self._cells), self._columns)
        x, y = CELL * (x + self._low[0]), CELL * (y + self._low[1])
        c, s = math.cos(self._start.yaw), math.sin(self._start.yaw)
        return np.column_stack([self._start.x + c * x - s * y, self._start.y + s * x + c * y])

    def _hopes(self) -> list[float]:
        """By cell: how long it takes to the nearest goal at least [s]."""
        places = self._places()
        away = [np.hypot(*(places - (goal.x, goal.y)).T) for goal in self._goals]
        hopes: list[float] = (np.min(away, axis=0) / self._pace.forward).tolist()
        return hopes

    def _number(self, x: int, y: int) -> int:
        return int((y - self._low[1]) * self._columns + x - self._low[0])

    def _pose(self, state: int) -> Pose:
        heading, cell = divmod(state, self._cells)
        row, column = divmod(cell, self._columns)
        x, y = CELL * (column + self._low[0]), CELL * (row + self._low[1])
        c, s = math.cos(self._start.yaw), math.sin(self._start.yaw)
        return Pose(self._start.x + c * x - s * y, self._start.y + s * x + c * y, self._start.yaw + self._yaws[heading])

    def _back(self, state: int, before: dict[int, int]) -> list[Pose]:
        found = [self._pose(state)]
        while before[state] != state:
            state = before[state]
            found.append(self._pose(state))
        return found[::-1]
