"""One folder for each kind of machine that plans motions; `planner:` of a machine file names it."""

from importlib import import_module

from tms_rp.kind import MachineKind


def load(name: str) -> MachineKind:
    """The kind of this name; the process table has checked that it is there."""
    found: MachineKind = import_module(f"{__name__}.{name}").KIND
    return found
