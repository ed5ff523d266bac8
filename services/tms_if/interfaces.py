"""Finds interface types by the names that the simulator uses: pkg/Type, or in full pkg/msg/Type."""

import importlib
from importlib.machinery import PathFinder
from pathlib import Path
from typing import Any, Literal

from tms_if.commands import CommandError

Kind = Literal["msg", "srv"]


def interface(name: str, kind: Kind) -> Any:
    """The Python class of a message or service.

    Raises:
        CommandError: the type is not built here.
    """
    package, *between, short = name.split("/")
    if between not in ([], [kind]):
        raise CommandError(f"'{name}' is no {'message' if kind == 'msg' else 'service'}: write {package}/{short}")
    found = getattr(_module(package, kind), short, None)
    if found is None or not hasattr(found, "_TYPE_SUPPORT"):
        raise CommandError(f"no {name} here: the package {package} is not built, or has no {kind}/{short}")
    return found


def short_name(full: str) -> str:
    """pkg/Type of pkg/msg/Type."""
    package, *_, short = full.split("/")
    return f"{package}/{short}"


def _module(package: str, kind: Kind) -> Any:
    """Import an interface package, and no other: a client must not make this process run any other module."""
    spec = PathFinder.find_spec(package)
    places = list(spec.submodule_search_locations or ()) if spec is not None else []
    if not any((Path(place) / kind / "__init__.py").is_file() for place in places):
        return None
    return importlib.import_module(f"{package}.{kind}")
