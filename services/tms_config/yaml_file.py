"""Reads a YAML file into a frozen model; every fault is an error that names file, line and key."""

from collections.abc import Hashable
from functools import lru_cache
from itertools import islice
from pathlib import Path
from typing import Any, TypeVar, cast

import yaml
from pydantic import ValidationError

from tms_config import reasons
from tms_config.models import Settings
from tms_reason.errors import ConfigError
from tms_reason.reason import Reason
from tms_reason.validation import Keys, dotted, problems

T = TypeVar("T", bound=Settings)
MERGE = "tag:yaml.org,2002:merge"
MAX_SHOWN = 5  # problems of one file in a message


class _BadMapping(yaml.MarkedYAMLError):
    """A mapping that PyYAML accepts and this project refuses."""

    def __init__(self, reason: Reason, mark: yaml.Mark) -> None:
        super().__init__(problem_mark=mark)
        self.reason = reason


class _Loader(yaml.CSafeLoader):
    """YAML that refuses a key given twice; PyYAML would keep the last one silently. Ten times as fast as SafeLoader."""


def _mapping(loader: _Loader, node: yaml.MappingNode) -> dict[Any, Any]:
    merged: dict[Any, Any] = {}
    seen: dict[Any, Any] = {}
    for key_node, value_node in node.value:
        if key_node.tag == MERGE:  # `<<: *other`: the keys of the other mapping, except those given here
            for other in value_node.value if isinstance(value_node, yaml.SequenceNode) else [value_node]:
                merged = {**_merged(loader, other, key_node.start_mark), **merged}
            continue
        key = loader.construct_object(key_node, deep=True)
        if not isinstance(key, Hashable):  # `{{ address }}` is a mapping as key of a mapping
            raise _BadMapping(reasons.NoKey(), key_node.start_mark)
        if key in seen:
            raise _BadMapping(reasons.KeyTwice(str(key)), key_node.start_mark)
        seen[key] = loader.construct_object(value_node, deep=True)
    return {**merged, **seen}


def _merged(loader: _Loader, node: yaml.Node, mark: yaml.Mark) -> dict[Any, Any]:
    found: object = loader.construct_object(node, deep=True)
    if not isinstance(found, dict):
        raise _BadMapping(reasons.NoMerge(), mark)
    return found


_Loader.add_constructor(yaml.resolver.BaseResolver.DEFAULT_MAPPING_TAG, _mapping)


def read_text(path: Path) -> str:
    """Content of a text file.

    Raises:
        ConfigError: it cannot be read, or is no UTF-8.
    """
    try:
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise ConfigError(reasons.BadFile(str(path), reasons.CannotBeRead(str(error.strerror)))) from error
    except UnicodeDecodeError as error:
        raise ConfigError(reasons.BadFile(str(path), reasons.NotUtf8())) from error


def read_yaml(path: Path, text: str | None = None) -> Any:
    """Parsed content of a YAML file; `text`: its content, where it was read already.

    Raises:
        ConfigError: it cannot be read or is no YAML.
    """
    try:
        return yaml.load(read_text(path) if text is None else text, _Loader)  # a safe loader
    except yaml.MarkedYAMLError as error:
        line = error.problem_mark.line + 1 if error.problem_mark else 0
        reason = error.reason if isinstance(error, _BadMapping) else reasons.NoYaml(str(error.problem))
        raise ConfigError(reasons.BadLine(str(path), line, reason)) from error
    except yaml.YAMLError as error:  # a character that YAML does not allow
        raise ConfigError(reasons.BadFile(str(path), reasons.NoYaml(str(error).splitlines()[0]))) from error


def parse(path: Path, model: type[T]) -> T:
    """A settings file as its model; as long as its text is the same, it is read once.

    Raises:
        ConfigError: names the file, the keys and what is wrong with them.
    """
    return cast(T, _checked(path, read_text(path), model))


@lru_cache(maxsize=16)  # a site file and its machine models take 20 ms; processes that are forked have them
def _checked(path: Path, text: str, model: type[Settings]) -> Settings:
    data = read_yaml(path, text)
    if not isinstance(data, dict):
        raise ConfigError(reasons.BadFile(str(path), reasons.NoMapping()))
    try:
        return model.model_validate(data)
    except ValidationError as error:
        found = [located(path, reason, *keys) for keys, reason in islice(problems(error), MAX_SHOWN)]
        more = error.error_count() - len(found)
        if more:
            found.append(reasons.AndMore(more))
        raise ConfigError(found[0] if len(found) == 1 else reasons.BadConfig(tuple(found))) from error


def located(path: Path, problem: Reason, *keys: int | str) -> Reason:
    """A problem with its file, line and key."""
    if not keys:
        return reasons.BadFile(str(path), problem)
    return reasons.BadKey(str(path), _line(yaml.compose(read_text(path), _Loader), keys), dotted(keys), problem)


def _line(node: yaml.Node | None, keys: Keys) -> int:
    """Line of a key, or of the nearest existing key above it."""
    line = 1 if node is None else node.start_mark.line + 1
    for key in keys:
        if isinstance(node, yaml.SequenceNode) and isinstance(key, int) and key < len(node.value):
            node = node.value[key]
            line = node.start_mark.line + 1
        elif isinstance(node, yaml.MappingNode):
            found = next(((name, value) for name, value in node.value if name.value == str(key)), None)
            if found is None:
                return line
            line, node = found[0].start_mark.line + 1, found[1]
        else:
            return line
    return line
