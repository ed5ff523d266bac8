"""The planted defects of `catalogue/*.yaml`: a text of a file, what takes its place, and what goes wrong then."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import yaml

SERVICES = Path(__file__).resolve().parents[2] / "services"
FOLDER = Path(__file__).resolve().parent / "catalogue"


class DoesNotApply(Exception):
    """The code has changed so that an entry must be written anew, or removed."""


@dataclass(frozen=True)
class Mutant:
    """One defect."""

    name: str
    file: str  # below services/
    text: str  # which the file has once
    becomes: str
    wrong: str  # what goes wrong, in words
    without: Sequence[str] = ()  # other defences against the same, which would hide it; see simulation.defences

    @property
    def package(self) -> str:
        """The package that has the defect."""
        return self.file.split("/")[0]

    def source(self, services: Path = SERVICES) -> str:
        """The file with the defect; raises DoesNotApply."""
        path = services / self.file
        if not path.is_file():
            raise DoesNotApply(f"{self.name}: there is no file {self.file}")
        source = path.read_text(encoding="utf-8")
        found = source.count(self.text)
        if found != 1:
            raise DoesNotApply(f"{self.name}: {self.file} has this text {found} times, not once: {self.text}")
        return source.replace(self.text, self.becomes)

    @property
    def sound(self) -> "Mutant":
        """The code as it is, with the same defences put out."""
        return replace(self, becomes=self.text)


def mutants(folder: Path = FOLDER) -> list[Mutant]:
    """All entries, in order of files and places in them; `file` and `mutants` are the keys of a file's parts."""
    found = []
    for path in sorted(folder.glob("*.yaml")):
        for part in yaml.safe_load(path.read_text(encoding="utf-8")):
            found += [Mutant(file=part["file"], **entry) for entry in part["mutants"]]
    return found
