"""How much longer than its model a machine has braked, on the disk of its PC. A file that cannot be read: the most."""

import json
from pathlib import Path

from tms_areas.braking import MOST
from tms_runtime import durable


class BrakingFile:
    """`<state>/rc/<machine>.braking`; a person who has had the brakes mended deletes it."""

    def __init__(self, folder: Path, machine: str) -> None:
        self._path = folder / "rc" / f"{machine}.braking"

    def read(self) -> float:
        """Times the model's distances; 1 where no receipt has shown more."""
        try:
            factor = json.loads(self._path.read_text(encoding="utf-8"))["factor"]
            return min(max(float(factor), 1.0), MOST)
        except FileNotFoundError:
            return 1.0
        except (OSError, ValueError, KeyError, TypeError):
            return MOST

    def keep(self, factor: float) -> None:
        """Write it.

        Raises:
            OSError: it could not be written.
        """
        durable.replace(self._path, json.dumps({"factor": factor}).encode())
