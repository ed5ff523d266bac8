"""Reads a YAML file into a frozen model; whatever is wrong is an error that names file and key."""

from collections.abc import Hashable
from pathlib import Path
from typing import Any, TypeVar

import yaml
from pydantic import ValidationError

from tms_config.models import Settings
from tms_reason.errors import ConfigError

T = TypeVar("T", bound=Settings)


class _Loader(yaml.CSafeLoader):
    """YAML that refuses a key given twice; PyYAML would keep the last one silently. Ten times as fast as SafeLoader."""


def _mapping(loader: _Loader, node: yaml.MappingNode) -> dict[Any, Any]:
    seen: dict[Any, Any] = {}
    for key_node, value_node in node.value:
        key = loader.construct_object(key_node, deep=True)
        if not isinstance(key, Hashable):  # `{{ address }}` is a mapping as key of a mapping
            problem = "a key is itself a mapping or a list: was a {{ placeholder }} not filled in?"
            raise yaml.MarkedYAMLError(problem=problem, problem_mark=key_node.start_mark)
        if key in seen:
            raise yaml.MarkedYAMLError(problem=f"key '{key}' is there twice", problem_mark=key_node.start_mark)
        seen[key] = loader.construct_object(value_node, deep=True)
    return seen


_Loader.add_constructor(yaml.resolver.BaseResolver.DEFAULT_MAPPING_TAG, _mapping)


def read_yaml(path: Path) -> Any:
    """Parsed content of a YAML file.

    Raises:
        ConfigError: it cannot be read or is no YAML.
    """
    try:
        return yaml.load(path.read_text(encoding="utf-8"), _Loader)  # a safe loader
    except OSError as error:
        raise ConfigError(f"{path}: cannot be read ({error.strerror})") from error
    except UnicodeDecodeError as error:
        raise ConfigError(f"{path}: is not UTF-8 text") from error
    except yaml.MarkedYAMLError as error:
        line = error.problem_mark.line + 1 if error.problem_mark else 0
        raise ConfigError(f"{path}:{line}: {error.problem}") from error
    except yaml.YAMLError as error:  # a character that no YAML may hold
        raise ConfigError(f"{path}: {str(error).splitlines()[0]}") from error


def parse(path: Path, model: type[T]) -> T:
    """A settings file as its model.

    Raises:
        ConfigError: names the file, the key and what is wrong with it.
    """
    data = read_yaml(path)
    if not isinstance(data, dict):
        raise ConfigError(f"{path}: must hold keys and values")
    try:
        return model.model_validate(data)
    except ValidationError as error:
        raise ConfigError(f"{path}: {explain(error)}") from error


def explain(error: ValidationError) -> str:
    """First problem of a validation, as `key: what`; says how many more there are."""
    first = error.errors()[0]
    key = ".".join(str(part) for part in first["loc"])
    message = "unknown key" if first["type"] == "extra_forbidden" else first["msg"].removeprefix("Value error, ")
    more = error.error_count() - 1
    return (f"{key}: " if key else "") + message + (f" (and {more} more)" if more else "")
