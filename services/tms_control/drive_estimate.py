"""Learns how a joint's drive answers: its droop while it moves, its dead time and lag after a move. Pure logic.

The droop is estimated by an observer: a model of the joint moves by the commands that were sent, and what it is off is
a droop that it did not know. Its poles are slow, so that errors of the lag during a motion weigh little.

Dead time and lag come from a fit over a whole move. Over each span of 0.2 s, a drive moves by
q(t + 0.2) - q(t) = (A - d * 0.2) / tau with A the integral of u(t - D) - q(t). For each dead time D that is possible
the best lag tau and droop d follow by least squares; the dead time with the least error wins.
"""

from collections import deque
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tms_control.control_law import ControlLaw

POLE = 1.0  # 1/s, both poles of the observer
HANGS = 0.3  # rad, the largest droop: at an end stop, a joint stays short of its commands for another reason
KEPT = 60.0  # s of a move that are remembered
SPAN = 0.2  # s
WIDEST, STEP = 0.15, 0.01  # s, dead times that are tried round the one that is known
MOVED = 0.05  # rad that a joint must have moved ...
LEADS = 0.05  # rad, ... and how far its commands must have been from it on average, so that a fit says anything
FITS = 0.3  # share of the motion that a fit may leave unexplained
WRONG = 3.0  # times the lag that is known; beyond it, something else than the drive has moved the joint

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Fit:
    """What a move has shown."""

    dead_time: float  # s
    lag: float  # s
    droop: float  # rad


class DriveEstimate:
    """Watches one joint, and keeps the figures of its control law up to date."""

    def __init__(self, law: ControlLaw) -> None:
        self._law = law
        self._model: tuple[float, float] | None = None  # s, rad: where the model of the joint is
        self._measured: deque[tuple[float, float]] = deque()  # s, rad
        self._sent: deque[tuple[float, float]] = deque()  # s, rad

    def sent(self, now: float, angle: float) -> None:
        """Take a command."""
        self._sent.append((now, angle))

    def measured(self, at: float, position: float) -> None:
        """Take a measurement; times only go on."""
        self._measured.append((at, position))
        for kept in (self._measured, self._sent):
            while kept and at - kept[0][0] > KEPT:
                kept.popleft()
        if self._model is not None and self._sent:
            self._observe(at, position)
        else:
            self._model = at, position

    def _observe(self, at: float, position: float) -> None:
        law = self._law
        assert self._model is not None
        before, model = self._model
        model, seconds = law.moved(model, before, at), at - before
        error = position - model
        law.droop = max(-HANGS, min(HANGS, law.droop - POLE**2 * law.lag * error * seconds))
        self._model = at, model + (2 * POLE - 1 / law.lag) * error * seconds

    def rest(self) -> None:
        """Forget the motion so far: something else than our commands moves the joint now."""
        self._model = None
        self._measured.clear()
        self._sent.clear()

    def learn(self) -> Fit | None:
        """Take over what the move since the last call has shown; None if it shows nothing."""
        found = self._fit()
        if found is not None:
            self._law.dead_time, self._law.lag, self._law.droop = found.dead_time, found.lag, found.droop
        self.rest()
        return found

    def _fit(self) -> Fit | None:
        if len(self._measured) < 2 or not self._sent:
            return None
        times, angles = (np.array(column) for column in zip(*self._measured, strict=True))
        if np.ptp(angles) < MOVED:
            return None
        sent, commands = (np.array(column) for column in zip(*self._sent, strict=True))
        known = self._law.dead_time
        tried = known + STEP * np.arange(-round(WIDEST / STEP), round(WIDEST / STEP) + 1)
        begins = times[(times > sent[0] + known + WIDEST) & (times < times[-1] - SPAN)]
        if len(begins) < round(1.0 / SPAN):
            return None
        way = np.interp(begins + SPAN, times, angles) - np.interp(begins, times, angles)
        gone = _integral(times, angles)
        been = np.interp(begins + SPAN, times, gone) - np.interp(begins, times, gone)
        fits = [
            _lag(_commanded(sent, commands, begins - dead_time) - been, way, float(dead_time))
            for dead_time in tried[tried >= 0.0]
        ]
        error, best = min(fits, key=lambda fit: fit[0], default=(np.inf, None))
        plausible = best is not None and 1 / WRONG < best.lag / self._law.lag < WRONG and abs(best.droop) < HANGS
        return best if plausible and error < FITS * float(np.linalg.norm(way)) else None


def _integral(times: Array, values: Array) -> Array:
    """The integral of values that change linearly, at each of these times."""
    return np.concatenate(([0.0], np.cumsum(np.diff(times) * (values[1:] + values[:-1]) / 2)))


def _commanded(sent: Array, commands: Array, begins: Array) -> Array:
    """The integral of the commands over a span from each of these times; a command stays until the next."""
    ends = np.append(sent, max(sent[-1], begins[-1] + SPAN) + 1.0)
    total = np.concatenate(([0.0], np.cumsum(np.diff(ends) * commands)))
    return np.asarray(np.interp(begins + SPAN, ends, total) - np.interp(begins, ends, total))


def _lag(leads: Array, way: Array, dead_time: float) -> tuple[float, Fit | None]:
    """The error of the best fit with this dead time, and the fit; None if the commands lead nowhere."""
    if float(np.mean(np.abs(leads))) < LEADS * SPAN:
        return np.inf, None
    factors = np.stack((leads, np.full_like(leads, SPAN)), axis=1)
    (inverse, drift), *_ = np.linalg.lstsq(factors, way, rcond=None)
    if inverse <= 0.0:
        return np.inf, None
    error = float(np.linalg.norm(factors @ np.array((inverse, drift)) - way))
    return error, Fit(dead_time, float(1 / inverse), float(-drift / inverse))
