"""Packages of ROS interfaces in another form: two forms of one package cannot live in one process.

Their libraries have the same names, and the loader gives the first one to both: messages of the second form are then
sent without the fields that it has more, and nothing tells of it. So the search paths are set before Python starts.
"""

import os
import sys
import sysconfig
from collections.abc import Sequence
from pathlib import Path

PREFIXES = Path(sys.prefix) / "share" / "tms_forms"  # `make interfaces` installs the forms here


def enter(forms: Sequence[str]) -> None:
    """Start this program anew (same pid) with the packages of some forms before the usual ones; once."""
    packages = Path(sysconfig.get_path("purelib")).relative_to(sys.prefix)
    before = {
        "LD_LIBRARY_PATH": [str(PREFIXES / form / "lib") for form in forms],
        "PYTHONPATH": [str(PREFIXES / form / packages) for form in forms],
    }
    if os.environ.get("PYTHONPATH", "").startswith(":".join(before["PYTHONPATH"])):
        return
    changed = {name: ":".join([*paths, os.environ.get(name, "")]) for name, paths in before.items()}
    sys.stdout.flush()
    os.execve(sys.executable, [sys.executable, "-m", "tms_runtime.run", *sys.argv[1:]], {**os.environ, **changed})
