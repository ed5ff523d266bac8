"""What machines have told since the ground was saved; after a crash it is taken again, so that nothing of it is lost.

Lines of JSON, as they were taken. Each save of the ground begins a new file, whose number is in the file of the ground.
They are not synced: they outlive the process, and a power cut takes the last seconds of them.
"""

import json
import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from tms_runtime import durable

MOST = 4_000_000  # bytes, which five machines fill in three minutes; then the ground is to be saved
FULL = 4 * MOST  # bytes, where the ground cannot be saved: then nothing more is written
RESTS = 0.8  # s of the machine between two lines of one that tells the same over and over: less than tms_soil.earth.GAP


class Told(NamedTuple):
    """Joints and place of a machine, as `GroundWatch.take` takes them."""

    machine: str
    time: float  # s of the machines
    angles: dict[str, float]  # rad
    place: tuple[float, float, float]  # m, rad, map


class Looked(NamedTuple):
    """A look at the work of a machine, as `GroundWatch.count` takes it, at what it told last."""

    machine: str
    now: float  # s since 1970
    duty: tuple[str, bool, bool]


class Journal:
    """The files beside that of a ground."""

    def __init__(self, file: Path) -> None:
        self._file = file
        self._out: int | None = None  # None: nothing is written
        self._last: dict[str, tuple[Told, Looked | None]] = {}
        self.number = max(self._there(), default=0)
        self.size = 0  # bytes of the present one
        self.trouble: OSError | None = None  # why nothing is written

    def begin(self) -> None:
        """Go on in a new file."""
        self.end()
        self.number, self.size, self.trouble = self.number + 1, 0, None
        self._last.clear()
        try:
            durable.make_folder(self._file.parent)
            self._out = os.open(self._path(self.number), os.O_WRONLY | os.O_CREAT | os.O_TRUNC | os.O_CLOEXEC, 0o600)
        except OSError as error:
            self.trouble = error

    def end(self) -> None:
        """Write nothing from now on."""
        if self._out is not None:
            os.close(self._out)
            self._out = None

    def told(self, told: Told, rests: bool) -> None:
        """Write what is to be taken; `rests`: it has changed nothing."""
        before = self._last.get(told.machine)
        if rests and before and before[0]._replace(time=told.time) == told and told.time - before[0].time < RESTS:
            return
        self._last[told.machine] = told, None
        self._write(told)

    def looked(self, looked: Looked) -> None:
        """Write a look, unless it is one more at a machine that rests."""
        before = self._last.get(looked.machine)
        if before is None or (before[1] is not None and before[1].duty == looked.duty):
            return
        self._last[looked.machine] = before[0], looked
        self._write(looked)

    def lines(self, first: int) -> Iterator[Told | Looked]:
        """What was written from a number on; what was cut off ends its file."""
        for number in sorted(one for one in self._there() if one >= first):
            for line in self._path(number).read_bytes().split(b"\n"):
                if (found := _parsed(line)) is None:
                    break
                yield found

    def drop(self, before: int) -> None:
        """Remove those below a number."""
        for number in self._there():
            if number < before:
                self._path(number).unlink(missing_ok=True)

    def _write(self, line: Told | Looked) -> None:
        if self._out is None or self.size > FULL:
            return
        data = json.dumps(line).encode() + b"\n"
        try:
            durable.write_all(self._out, data)
        except OSError as error:
            self.end()
            self.trouble = error
        self.size += len(data)

    def _path(self, number: int) -> Path:
        return self._file.with_name(f"{self._file.name}.{number}")

    def _there(self) -> list[int]:
        ends = (one.name.removeprefix(f"{self._file.name}.") for one in self._file.parent.glob(f"{self._file.name}.*"))
        return [int(end) for end in ends if end.isdecimal()]


def _parsed(line: bytes) -> Told | Looked | None:
    try:
        found: Any = json.loads(line)
        match found:
            case [str(machine), float(time), dict(angles), [float(x), float(y), float(yaw)]] if _are_numbers(angles):
                return Told(machine, time, angles, (x, y, yaw))
            case [str(machine), float(now), [str(run), bool(moves), bool(stopped)]]:
                return Looked(machine, now, (run, moves, stopped))
    except ValueError:
        pass
    return None


def _are_numbers(angles: Mapping[Any, Any]) -> bool:
    return all(isinstance(one, float) for one in angles.values())
