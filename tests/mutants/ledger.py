"""What is done already, in a file, so that a long series can be continued."""

import hashlib
import json
from dataclasses import asdict
from functools import cache
from pathlib import Path

from mutants.catalogue import SERVICES, Mutant
from mutants.plant import TESTS, Verdict


@cache
def code() -> str:
    """A digest of what decides, and of what simulates."""
    digest = hashlib.sha256()
    for folder in (SERVICES / "tms_decision", SERVICES / "tms_proof", TESTS / "simulation"):
        for path in sorted(folder.rglob("*.py")):
            digest.update(path.read_bytes())
    return digest.hexdigest()


class Ledger:
    """Verdicts by mutant; they count while the mutant, the code and the first seed stay the same."""

    def __init__(self, path: Path | None, seed: int, schedules: int) -> None:
        self._path, self._seed, self._schedules = path, seed, schedules
        self._verdicts: dict[str, Verdict] = {}
        for line in path.read_text(encoding="utf-8").splitlines() if path is not None and path.exists() else []:
            key, values = json.loads(line)
            self._verdicts[key] = Verdict(**values)

    def _key(self, mutant: Mutant) -> str:
        return hashlib.sha256(f"{self._seed}\n{code()}\n{mutant}".encode()).hexdigest()[:16]

    def known(self, mutant: Mutant) -> Verdict | None:
        """The verdict of an earlier call that has tried as many schedules, or has found a violation in them."""
        verdict = self._verdicts.get(self._key(mutant))
        if verdict is None or (
            verdict.tried < self._schedules if verdict.survived else verdict.tried > self._schedules
        ):
            return None
        return verdict

    def keep(self, mutant: Mutant, verdict: Verdict) -> None:
        """Add a verdict."""
        if self._path is not None:
            with self._path.open("a", encoding="utf-8") as file:
                file.write(json.dumps([self._key(mutant), asdict(verdict)]) + "\n")
