"""Which release this is."""

import importlib.metadata


def version() -> str:
    """Version of the installed project."""
    return importlib.metadata.version("ros2-tms")
