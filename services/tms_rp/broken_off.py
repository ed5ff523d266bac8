"""Stored plans that were broken off: the rest of their path, from where the arm stands on it.

A motion and its stop leave the arm beside the path, as each joint answers with a dead time and a lag of its own. It
comes back to the nearest place of the path first.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from trajectory_msgs.msg import JointTrajectory

from tms_config.models import Joint
from tms_rp.plans import one_trajectory, without_stops
from tms_rp.reasons import GoesOn
from tms_rp.trajectory import Joints, Trajectory, TrajectorySample, trajectory


@dataclass(frozen=True)
class Place:
    """A place on the path of a trajectory: before a sample, at a time [s], with the angles there [rad]."""

    sample: int
    time: float
    positions: Joints


def rest(
    joints: dict[str, Joint], aside: Sequence[float], now: Joints, plans: Sequence[JointTrajectory]
) -> tuple[Trajectory, GoesOn] | None:
    """The rest of plans, and where it goes on; None where the arm does not stand on their path.

    `aside`: how far [rad] each joint may be beside it. The rest is on the path but for its corners, and no faster.
    Collisions are not looked at.

    Raises:
        SubtaskFailed: PlanWrong, LimitsLeft.
    """
    whole = one_trajectory(joints, _begin(joints, now, plans[0]), plans)
    place = _nearest(whole, now, aside)
    if place is None:
        return None
    number, _ = whole.progress(place.time)
    back, left = trajectory(joints, now, [place.positions]), _from(whole, place)
    on = back if left is None else _after(back, without_stops(joints, left))
    return on, GoesOn(number, max(0.0, place.time - (0.0, *whole.stops)[number - 1]))


def _begin(joints: Mapping[str, Joint], now: Joints, plan: JointTrajectory) -> Joints:
    """Where a plan begins; joints that it does not name stay."""
    told = dict(zip(plan.joint_names, plan.points[0].positions, strict=False)) if plan.points else {}
    return tuple(told.get(name, angle) for name, angle in zip(joints, now, strict=True))


def _nearest(whole: Trajectory, now: Joints, aside: Sequence[float]) -> Place | None:
    """The place of the path that is nearest to the arm, the first of those that are equally near."""
    poses, here = (np.array(one) / aside for one in ([sample.positions for sample in whole.samples], now))
    ways = np.diff(poses, axis=0)
    lengths, onwards = (ways**2).sum(axis=1), (ways * (here - poses[:-1])).sum(axis=1)
    parts = np.divide(onwards, lengths, out=np.zeros(len(ways)), where=lengths > 0).clip(0.0, 1.0)
    places = poses[:-1] + parts[:, None] * ways
    away = np.abs(places - here).max(axis=1)
    found = int(away.argmin())
    if away[found] > 1.0:
        return None
    before, after = whole.samples[found], whole.samples[found + 1]
    time = before.time + float(parts[found]) * (after.time - before.time)
    return Place(found + 1, time, tuple(map(float, places[found] * aside)))


def _from(whole: Trajectory, place: Place) -> Trajectory | None:
    """What comes behind a place, from rest there; None if nothing does."""
    ends = [stop for stop in whole.stops if stop > place.time]
    later = [sample for sample in whole.samples[place.sample :] if sample.time > place.time]
    if not ends or not later:
        return None
    still = (0.0,) * len(place.positions)
    begun = TrajectorySample(0.0, place.positions, still, still)
    samples = [begun, *(replace(sample, time=sample.time - place.time) for sample in later)]
    return Trajectory(whole.names, tuple(samples), tuple(stop - place.time for stop in ends))


def _after(back: Trajectory, left: Trajectory) -> Trajectory:
    """The way back to the path, then what is left of it, with the ends of the plans as the only stops."""
    if back.stops[-1] == 0:
        return left
    return replace(back.then(left), stops=tuple(stop + back.duration for stop in left.stops))
