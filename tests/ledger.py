"""A file of what a long series has done already, so that the same command continues it."""

import json
from pathlib import Path
from typing import Any


class Lines:
    """Pairs of a key and values, each a line of JSON; without a path nothing is read or kept."""

    def __init__(self, path: Path | None) -> None:
        self._path = path
        lines = path.read_text(encoding="utf-8").splitlines() if path is not None and path.exists() else []
        self.read: list[tuple[Any, Any]] = [(key, values) for key, values in map(json.loads, lines)]

    def keep(self, key: object, values: object) -> None:
        """Add a pair."""
        if self._path is not None:
            with self._path.open("a", encoding="utf-8") as file:
                file.write(json.dumps([key, values]) + "\n")
