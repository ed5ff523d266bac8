"""A way between two poses through a scene, searched by OMPL's RRT-Connect and shortened.

The same poses in the same scene give the same way: each search draws from the same seed, and it is bounded by
iterations, not by time.
"""

import zlib
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from ompl import base, geometric, util

from tms_rp.kind import Angles

ITERATIONS = 1000  # of RRT-Connect: most ways are found within 100, none of the recorded ones needs 500
SHORTENING = 30  # steps of each kind
RANGE = 0.6  # rad between two poses of the search at most

Bounds = Sequence[tuple[float, float]]  # rad, by joint
Free = Callable[[Sequence[Angles]], bool]  # whether the straight lines between poses are free


def search(start: Angles, targets: Sequence[Angles], bounds: Bounds, free: Free, seed: int) -> tuple[Angles, ...]:
    """Poses from `start` to one of `targets`, without the start; empty if no way was found. All [rad]."""
    util.noOutputHandler()  # it complains of each seed but the first; those after it count all the same
    util.RNG.setSeed(1 + zlib.crc32(np.round([start, *targets], 3).tobytes(), seed))
    info = _space(bounds, free)
    problem = base.ProblemDefinition(info)
    problem.addStartState(_state(info, start))
    goal = base.GoalStates(info)
    for target in targets:
        goal.addState(_state(info, target))
    problem.setGoal(goal)
    planner = geometric.RRTConnect(info)
    planner.setRange(RANGE)
    planner.setProblemDefinition(problem)
    planner.setup()
    if not planner.solve(base.PlannerTerminationCondition(_Counter(ITERATIONS))) or not problem.hasExactSolution():
        return ()
    path = problem.getSolutionPath()
    shortened = geometric.PathSimplifier(info)
    shortened.reduceVertices(path, SHORTENING, SHORTENING)
    shortened.partialShortcutPath(path, SHORTENING, SHORTENING)
    shortened.reduceVertices(path, SHORTENING, SHORTENING)
    return tuple(_angles(state, len(bounds)) for state in path.getStates()[1:])


def _space(bounds: Bounds, free: Free) -> Any:
    count = len(bounds)
    space, box = base.RealVectorStateSpace(count), base.RealVectorBounds(count)
    for joint, (low, high) in enumerate(bounds):
        box.setLow(joint, low)
        box.setHigh(joint, high)
    space.setBounds(box)
    info = base.SpaceInformation(space)
    info.setStateValidityChecker(lambda state: free([_angles(state, count)]))

    class Lines(base.MotionValidator):  # type: ignore[misc]
        """Looks at a whole line at once: ten times as fast as pose by pose."""

        def checkMotion(self, a: Any, b: Any, *_: Any) -> bool:  # noqa: N802
            return free([_angles(a, count), _angles(b, count)])

    info.setMotionValidator(Lines(info))
    info.setup()
    return info


class _Counter:
    """Ends a search after so many iterations: OMPL asks once in each."""

    def __init__(self, limit: int) -> None:
        self._left = limit

    def __call__(self) -> bool:
        self._left -= 1
        return self._left < 0


def _state(info: Any, angles: Angles) -> Any:
    state = info.allocState()
    for joint, angle in enumerate(angles):
        state[joint] = angle
    return state


def _angles(state: Any, count: int) -> Angles:
    return tuple(float(state[joint]) for joint in range(count))
