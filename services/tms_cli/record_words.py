"""Parses records on the command line: MODEL/RECORD and field=value."""

import re
from collections.abc import Iterable
from typing import Any

import click
import yaml

from tms_cli.reasons import FieldValue, NotAFiniteNumber, ValueEmpty, ValueUnreadable
from tms_reason.errors import TmsError
from tms_reason.validation import Wrong

NOT_FINITE = re.compile(r"[-+]?\.?(nan|inf|infinity)", re.IGNORECASE)


class _Scalars(yaml.SafeLoader):
    """The scalars of YAML 1.2: 1e3 is a number; `010`, `yes` and `1:30` have no hidden meaning as in YAML 1.1."""


_Scalars.yaml_implicit_resolvers = {}
for _tag, _pattern, _first in (
    ("bool", r"(true|false|True|False)$", "tfTF"),
    ("null", r"(null|~)$", "n~"),
    ("int", r"[-+]?[0-9]+$", "-+0123456789"),
    ("float", r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?$", "-+.0123456789"),
):
    _Scalars.add_implicit_resolver(f"tag:yaml.org,2002:{_tag}", re.compile(_pattern), list(_first))
_Scalars.add_constructor("tag:yaml.org,2002:int", lambda _, node: int(node.value))
_Scalars.add_constructor("tag:yaml.org,2002:float", lambda _, node: float(node.value))


def parse_value(text: str) -> Any:
    """The value that `field=text` means: number, true/false, array, or text.

    Raises:
        Wrong: the text is none of these; says why.
    """
    if NOT_FINITE.fullmatch(text):
        raise Wrong(NotAFiniteNumber(text))
    try:
        value = yaml.load(text, _Scalars)  # a SafeLoader
    except yaml.YAMLError as error:
        raise Wrong(ValueUnreadable(repr(text))) from error
    if value is None or (value == "" and not text.strip()):
        raise Wrong(ValueEmpty())
    return value


def parse_fields(where: str, words: Iterable[str]) -> dict[str, Any]:
    """`field=value` words as typed fields of the record that messages call `where`.

    Raises:
        click.UsageError: a word is not of this form.
        TmsError: a value cannot be stored; names the field.
    """
    from tms_db.records import check_values

    fields: dict[str, Any] = {}
    for word in words:
        name, equals, text = word.partition("=")
        if not equals or not name:
            raise click.UsageError(f"'{word}': write field=value, for example swing_joint=-1.571")
        if name in fields:
            raise click.UsageError(f"field '{name}' is given twice")
        try:
            fields[name] = parse_value(text)
        except Wrong as error:
            raise TmsError(FieldValue(where, name, error.reason), "BAD_VALUE") from error
    check_values(where, fields)
    return fields


class Key(click.ParamType[tuple[str, str]]):
    """MODEL/RECORD, or /RECORD for a record that all machines share."""

    name = "MODEL/RECORD"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[str, str]:
        model, slash, record = str(value).partition("/")
        if not slash or not record:
            self.fail(f"'{value}': write MODEL/RECORD (zx200/initial_pose), or /RECORD for a shared one", param, ctx)
        return model, record


key_argument = click.argument("key", type=Key(), metavar="MODEL/RECORD")
