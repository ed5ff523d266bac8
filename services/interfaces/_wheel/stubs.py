"""Types of all installed ROS interfaces for mypy: a stub package `<package>-stubs` beside each of them.

rosidl generates Python without annotations, so the classes themselves are asked for their fields.
Run by `make interfaces`; the one argument is the folder to write to, without it that of the installed packages.
"""

import inspect
import re
import shutil
import sys
import sysconfig
from collections.abc import Iterator
from importlib import import_module, util
from pathlib import Path
from types import ModuleType
from typing import Any

from rosidl_parser import definition as idl

INDEX = "share/ament_index/resource_index/rosidl_interfaces"
INDENT = "    "
HEAD = """import array
import collections.abc
import typing

import numpy
import numpy.typing
"""
SEQUENCE = "collections.abc.Sequence"
PARTS = (("Request", "Response"), ("Goal", "Result", "Feedback"))


def scalar(kind: Any) -> str:
    """The Python type of one value that is no sequence."""
    if isinstance(kind, idl.NamespacedType):
        package, folder, name = kind.namespaced_name()
        return f"{package}.{folder}.{name.replace('_', '.')}"  # `Trigger_Request` is nested as `Trigger.Request`
    if isinstance(kind, (idl.AbstractString, idl.AbstractWString)):
        return "str"
    name = kind.typename
    if name == idl.OCTET_TYPE:
        return "bytes"
    if name == idl.BOOLEAN_TYPE:
        return "bool"
    return "float" if name in idl.FLOATING_POINT_TYPES else "int"


def stored_as_numbers(kind: Any) -> bool:
    """Whether rosidl packs the values of a sequence: a list that is set is another object when read."""
    value = kind.value_type
    packed = {*idl.FLOATING_POINT_TYPES, *idl.EXPLICIT_INTEGER_TYPES}
    return isinstance(value, idl.BasicType) and value.typename in packed


def numpy_array(kind: Any) -> str:
    """The type of a numpy array of such numbers."""
    names = {"float": "float32", "double": "float64"}
    name = kind.value_type.typename
    return f"numpy.typing.NDArray[numpy.{names.get(name, name)}]"


def read(kind: Any) -> str:
    """What a field gives."""
    if not isinstance(kind, idl.AbstractNestedType):
        return scalar(kind)
    value = scalar(kind.value_type)
    if not stored_as_numbers(kind):
        return f"list[{value}]"
    return numpy_array(kind) if isinstance(kind, idl.Array) else f"array.array[{value}]"


def written(kind: Any) -> str:
    """What a field takes."""
    if not isinstance(kind, idl.AbstractNestedType):
        return scalar(kind)
    sequence = f"{SEQUENCE}[{scalar(kind.value_type)}]"
    return f"{sequence} | {numpy_array(kind)}" if stored_as_numbers(kind) else sequence


def constants(message: type) -> Iterator[tuple[str, str]]:
    """Names and types of the constants of a message."""
    for name, value in type(message).__prepare__("", ()).items():
        if not name.endswith("__DEFAULT"):
            yield name, type(value).__name__


def field(name: str, kind: Any) -> list[str]:
    """The lines of one field: an attribute, or a property where it takes more than it gives."""
    if read(kind) == written(kind):
        return [f"{name}: {read(kind)}"]
    return [
        "@property",
        f"def {name}(self) -> {read(kind)}: ...",
        f"@{name}.setter",
        f"def {name}(self, value: {written(kind)}) -> None: ...",
    ]


def message_body(message: Any) -> list[str]:
    """The lines inside the class of a message."""
    fields = dict(zip(message.get_fields_and_field_types(), message.SLOT_TYPES, strict=True))
    lines = [f"{name}: typing.ClassVar[{kind}]" for name, kind in constants(message)]
    for name, kind in fields.items():
        lines += field(name, kind)
    arguments = "".join(f", {name}: {written(kind)} = ..." for name, kind in fields.items())
    star = ", *" if fields else ""
    lines.append(f"def __init__(self{star}{arguments}) -> None: ...")
    lines += ["@classmethod", "def get_fields_and_field_types(cls) -> dict[str, str]: ..."]
    return lines


def is_message(found: type) -> bool:
    """Whether a class is a message; services and actions only hold the classes of theirs."""
    return hasattr(found, "get_fields_and_field_types")


def holder_body(holder: type) -> list[str]:
    """The lines inside the class of a service or an action, or of a part of one that is no message."""
    lines = []
    for name, nested in vars(holder).items():
        if not inspect.isclass(nested) or name == "Event":  # of service introspection, which is not used
            continue
        if nested.__module__ == holder.__module__:
            lines += class_lines(name, nested)
        else:  # what all actions share
            package, folder, _ = nested.__module__.split(".")
            lines.append(f"{name} = {package}.{folder}.{nested.__name__}")
    for parts in PARTS:
        if all(hasattr(holder, part) for part in parts):
            arguments = ", ".join(f"{part.lower()}: {part}" for part in parts)
            # For mypy only: without it a client of one service would take the requests of another.
            lines += ["@staticmethod", f"def _types({arguments}) -> None: ..."]
    return lines


def class_lines(name: str, found: type) -> list[str]:
    """A message, service or action with what is nested in it."""
    body = message_body(found) if is_message(found) else holder_body(found)
    return [f"class {name}:", *(INDENT + line for line in body), ""]


def module_text(module: ModuleType) -> str:
    """The stub of `<package>.msg`, `.srv` or `.action`."""
    lines: list[str] = []
    for name, found in sorted(vars(module).items()):
        if inspect.isclass(found) and "_" not in name:  # `SetDumpAngle_SendGoal_Event`: parts, nested already
            lines += class_lines(name, found)
    text = "\n".join(lines)
    return "\n".join([HEAD + "".join(f"import {name}\n" for name in named_modules(text)), text])


def named_modules(text: str) -> list[str]:
    """The interface modules that a stub refers to."""
    return sorted(set(re.findall(r"\b(\w+\.(?:msg|srv|action))\.", text)))


def write(package: str, folder: Path) -> None:
    """Write the stub package of one installed package, in place of an older one."""
    target = folder / f"{package}-stubs"
    shutil.rmtree(target, ignore_errors=True)
    for kind in ("msg", "srv", "action"):
        if util.find_spec(f"{package}.{kind}") is not None:
            (target / kind).mkdir(parents=True)
            (target / kind / "__init__.pyi").write_text(module_text(import_module(f"{package}.{kind}")))
            (target / "__init__.pyi").touch()


def main() -> None:
    """Write the stubs of all interface packages."""
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else sysconfig.get_path("purelib"))
    for entry in sorted((Path(sys.prefix) / INDEX).iterdir()):
        if util.find_spec(entry.name) is not None:
            write(entry.name, folder)


if __name__ == "__main__":
    main()
