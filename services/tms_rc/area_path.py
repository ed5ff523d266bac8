"""Where the enabled areas of a machine are; apart from what reads them, whose libraries few gateways load."""

from pathlib import Path


def area_path(state: Path, machine: str) -> Path:
    """Their file in a state folder: `<state>/rc/<machine>.areas`; it is there once some were enabled."""
    return state / "rc" / f"{machine}.areas"
