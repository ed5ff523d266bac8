"""Packages of ROS interfaces in another form: two forms of one package cannot live in one process.

Their libraries have the same names, and the loader gives the first one to both: messages of the second form are then
sent without the fields that it has more, and nothing tells of it. So the search paths are set before Python starts.
"""

import os
import sys
import sysconfig
from pathlib import Path

PREFIXES = Path(sys.prefix) / "share" / "tms_forms"  # `make interfaces` installs the forms here


def enter(form: str) -> None:
    """Start this program anew (same pid) with the packages of a form before the usual ones; once."""
    prefix = PREFIXES / form
    packages = prefix / Path(sysconfig.get_path("purelib")).relative_to(sys.prefix)
    before = {"LD_LIBRARY_PATH": prefix / "lib", "PYTHONPATH": packages}
    if os.environ.get("PYTHONPATH", "").startswith(str(packages)):
        return
    changed = {name: f"{path}:{os.environ.get(name, '')}" for name, path in before.items()}
    sys.stdout.flush()
    os.execve(sys.executable, [sys.executable, "-m", "tms_runtime.run", *sys.argv[1:]], {**os.environ, **changed})
