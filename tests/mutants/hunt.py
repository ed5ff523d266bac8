"""Simulated schedules until one violates an invariant, in the process of one mutant; `run.py` starts it.

For a mutant of the areas these are histories of `tests/areas`, of machines that dash at the borders.

Each seed is printed before its schedule, so that it is known where a defect has ended the process.
"""

import json
import resource
import sys
from importlib.util import find_spec
from pathlib import Path

from areas.history import run
from simulation.defences import put_out
from simulation.schedule import Schedule

LONGEST = 10  # s of CPU time of a schedule, which takes 0.03 s to 0.5 s: a defect may let it go on for ever
AREAS = "tms_areas"


def violation(package: str, seed: int) -> str:
    """What goes wrong with a seed; empty if nothing does."""
    return run(seed, dash=True).violation if package == AREAS else Schedule(seed).run().violation


def hunt(package: str, seed: int, schedules: int) -> None:
    """Print the first violation, if there is one."""
    for one in range(seed, seed + schedules):
        print(json.dumps({"seed": one}), flush=True)
        _limit()
        found = violation(package, one)
        if found:
            print(json.dumps({"violation": found}), flush=True)
            return


def _limit() -> None:
    usage = resource.getrusage(resource.RUSAGE_SELF)
    seconds = int(usage.ru_utime + usage.ru_stime) + LONGEST
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, resource.RLIM_INFINITY))


if __name__ == "__main__":
    package, seed, schedules, *without = sys.argv[1:]
    spec = find_spec(package)
    if spec is None or spec.origin is None or not Path(spec.origin).is_relative_to(Path.cwd()):
        sys.exit(f"{package} is not the planted one")
    for defence in without:
        put_out(defence)
    hunt(package, int(seed), int(schedules))
