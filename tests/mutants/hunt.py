"""Simulated schedules until one violates an invariant, in the process of one mutant; `run.py` starts it.

Each seed is printed before its schedule, so that it is known where a defect has ended the process.
"""

import json
import resource
import sys
from importlib.util import find_spec
from pathlib import Path

from simulation.schedule import Schedule

LONGEST = 10  # s of CPU time of a schedule, which takes 0.03 s: a defect may let it go on for ever


def hunt(seed: int, schedules: int) -> None:
    """Print the first violation, if there is one."""
    for one in range(seed, seed + schedules):
        print(json.dumps({"seed": one}), flush=True)
        _limit()
        violation = Schedule(one).run().violation
        if violation:
            print(json.dumps({"violation": violation}), flush=True)
            return


def _limit() -> None:
    usage = resource.getrusage(resource.RUSAGE_SELF)
    seconds = int(usage.ru_utime + usage.ru_stime) + LONGEST
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, resource.RLIM_INFINITY))


if __name__ == "__main__":
    package, seed, schedules = sys.argv[1:]
    spec = find_spec(package)
    if spec is None or spec.origin is None or not Path(spec.origin).is_relative_to(Path.cwd()):
        sys.exit(f"{package} is not the planted one")
    hunt(int(seed), int(schedules))
