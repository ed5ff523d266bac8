"""Whether paths of tracks keep clear of what stands on the ground, and where they do not."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tms_control.ground import Array, Ground, Mask, Outline
from tms_control.path import Piece, Pose
from tms_control.reasons import GoalTaken, StandsIn
from tms_reason.reason import Reason

CLEAR = 0.5  # m to keep to everything: `footprint_padding` of the navigation of the real machines
STEP, LEAST_STEP = 0.25, 0.05  # m that no corner moves further between two poses that are looked at
PART = 0.7  # of a smaller gap at an end: round bodies are polygons here, and places some centimetres off
TOUCH = 0.1  # m to keep while it drives: places that are told are some centimetres apart each time
ROUNDING = 1e-6  # m

Cells = NDArray[np.int_]


@dataclass(frozen=True)
class Contact:
    """The first place of a path that is too near to something, and how far along the path it is [m]."""

    name: Reason
    x: float
    y: float
    away: float


def array(*poses: Pose) -> Array:
    """Poses as N x 3."""
    return np.array(poses, dtype=float).reshape(-1, 3)


def needed(ground: Ground, outline: Outline, start: Pose, goal: Pose) -> Array | Reason:
    """How far a way between two poses has to keep from each body [m]; or why there is none.

    Of what is nearer at an end, most of that gap is kept. A body that may have moved may stand in the goal; that
    it does not stand in the start is known.
    """
    found = []
    for body in ground.bodies:
        here, there = body.gaps(outline, array(start, goal))
        if here <= 0:
            return StandsIn(body.name)
        least = min(CLEAR + body.growth, PART * float(here), max(PART * float(there), body.growth))
        if there < least or there <= 0:
            return GoalTaken(body.name, float(there), max(least, ROUNDING))
        found.append(least - ROUNDING)
    return np.array(found)


class WayCheck:
    """Looks at paths of one machine; `needed`: m to each body."""

    def __init__(self, ground: Ground, outline: Outline, needed: Array) -> None:
        self._ground, self.outline, self._needed = ground, outline, needed
        self._step = min(STEP, max(LEAST_STEP, float(needed.min(initial=STEP))))

    def free(self, pieces: Sequence[Piece]) -> bool:
        """Whether pieces keep clear."""
        return not self.taken(np.concatenate([self._poses(piece) for piece in pieces])).any() if pieces else True

    def first_free(self, options: Sequence[list[Piece]]) -> list[Piece] | None:
        """The first of some paths that keeps clear; all are looked at at once."""
        parts = [(number, self._poses(piece)) for number, pieces in enumerate(options) for piece in pieces]
        if not parts:
            return options[0] if options else None
        owners = np.concatenate([np.full(len(poses), number) for number, poses in parts])
        bad = set(np.unique(owners[self.taken(np.concatenate([poses for _, poses in parts]))]).tolist())
        return next((pieces for number, pieces in enumerate(options) if number not in bad), None)

    def taken(self, poses: Array) -> Mask:
        """Which poses (N x 3) are too near to something: N."""
        return np.asarray(self._ground.nearer(self.outline, poses, self._needed).any(axis=1))

    def first(self, pieces: Sequence[Piece]) -> Contact | None:
        """Where pieces first do not keep clear."""
        away = 0.0
        for piece in pieces:
            poses = self._poses(piece)
            near = self._ground.nearer(self.outline, poses, self._needed)
            if near.any():
                pose = int(np.argmax(near.any(axis=1)))
                name = self._ground.bodies[int(np.argmax(near[pose]))].name
                x, y, _ = map(float, poses[pose])
                return Contact(name, x, y, away + piece.length * pose / (len(poses) - 1))
            away += piece.length
        return None

    def near(self, places: Array) -> list[tuple[Cells, Cells, "WayCheck"]]:
        """By body: numbers of the places (N x 2) that are taken in any heading, of those that may be, and its check."""
        found = []
        outline = self.outline
        # In any heading the machine covers a circle around the place, if that lies inside of its outline.
        covered = max(0.0, float(outline.offsets.min()))
        for body, least in zip(self._ground.bodies, self._needed, strict=True):
            close = body.close(places, outline.reach + float(least))
            away = body.away(places[close])
            taken = away < covered + (least if covered else 0.0)
            maybe = ~taken & (away < outline.reach + least)
            found.append((close[taken], close[maybe], WayCheck(Ground((body,)), outline, least[None])))
        return found

    def _poses(self, piece: Piece) -> Array:
        return along(piece, self._step, self.outline.reach)


def blocked(ground: Ground, outline: Outline, coming: Sequence[Piece]) -> Contact | None:
    """What stands where a machine drives next, as it was told; not what is that near already."""
    if not coming or not ground.bodies:
        return None
    gaps = [float(body.gaps(outline, array(coming[0].start))[0]) for body in ground.bodies]
    return WayCheck(ground, outline, np.array([min(TOUCH, gap) - ROUNDING for gap in gaps])).first(coming)


def along(piece: Piece, step: float, reach: float) -> Array:
    """Poses of a piece from begin to end (N x 3), between which no point within `reach` moves further than `step`."""
    count = max(1, math.ceil((piece.length + abs(piece.turn) * reach) / step))
    share = np.arange(count + 1) / count
    half = piece.turn * share / 2  # a chord of an arc points to the middle of both headings
    chord = piece.direction * piece.length * share * np.sinc(half / math.pi)
    x, y, yaw = piece.start
    return np.stack([x + chord * np.cos(yaw + half), y + chord * np.sin(yaw + half), yaw + 2 * half], axis=1)
