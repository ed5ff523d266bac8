"""What is done already, in a file, so that a long series can be continued."""

import hashlib
from dataclasses import asdict
from functools import cache
from pathlib import Path

from ledger import Lines
from mutants.catalogue import SERVICES, Mutant
from mutants.plant import TESTS, Verdict


@cache
def code() -> str:
    """A digest of what decides, and of what simulates."""
    digest = hashlib.sha256()
    packages = (SERVICES / name for name in ("tms_areas", "tms_decision", "tms_proof", "tms_ts"))
    for folder in (*packages, TESTS / "simulation", TESTS / "areas"):
        for path in sorted(folder.rglob("*.py")):
            digest.update(path.read_bytes())
    return digest.hexdigest()


class Ledger:
    """Verdicts by mutant; they count while the mutant, the code and the first seed stay the same."""

    def __init__(self, path: Path | None, seed: int, schedules: int) -> None:
        self._lines, self._seed, self._schedules = Lines(path), seed, schedules
        self._verdicts = {key: Verdict(**values) for key, values in self._lines.read}

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
        self._lines.keep(self._key(mutant), asdict(verdict))
