"""`tms user`: the users of the console. Passwords and tokens are kept as argon2 hashes."""

import secrets
from pathlib import Path
from typing import Any

import click
import yaml

from tms_cli import session
from tms_cli.reasons import BadUserName, NoUser, NoUsersKey, ShortPassword
from tms_cli.words import Group
from tms_config.yaml_file import parse
from tms_reason.errors import TmsError

SHORTEST = 8  # characters of a password
NAME = click.Path(path_type=Path, dir_okay=False)
file_option = click.option("--file", type=NAME, metavar="FILE", help="Users file (default: console.users of the site).")


@click.group(cls=Group)
def command() -> None:
    """Users of the console and its API: viewer (look, stop), operator (and run, re-arm), admin (and change data).

    A change counts when the console has been restarted.

    \b
    Examples:
      tms user add mina --role operator
      tms user add logger --role viewer --token
      tms user list
      tms restart tms:ur
    """


@command.command()
@click.argument("name")
@click.option("--role", type=click.Choice(["viewer", "operator", "admin"]), required=True)
@click.option("--token", is_flag=True, help="Make a token for a program instead of asking for a password.")
@file_option
@session.json_option
def add(name: str, role: str, token: bool, file: Path | None, as_json: bool) -> None:
    """Add a user, or give an old one a new password or token.

    \b
    Examples:
      tms user add mina --role operator
      tms user add logger --role viewer --token
    """
    from tms_ur.access import hashed

    if not name.replace("_", "").replace("-", "").replace(".", "").isalnum() or len(name) > 64:
        raise TmsError(BadUserName(name), "BAD_NAME")
    path = _path(file)
    users = _read(path) if path.exists() else {}
    if token:
        secret = secrets.token_urlsafe(32)
        users[name] = {"role": role, "token": hashed(secret)}
    else:
        secret = click.prompt("Password", hide_input=True, confirmation_prompt=True, err=True)
        if len(secret) < SHORTEST:
            raise TmsError(ShortPassword(SHORTEST))
        users[name] = {"role": role, "password": hashed(secret)}
    _write(path, users)
    shown = f"{name}:{secret}" if token else None
    if as_json:
        session.show_json({"name": name, "role": role, "token": shown, "file": str(path)})
        return
    click.echo(f"{name} is {role} in {path}; `tms restart tms:ur` lets the console know", err=True)
    if shown:
        click.echo("its token, shown only now, for `Authorization: Bearer ...`:", err=True)
        click.echo(shown)


@command.command("list")
@file_option
@session.json_option
def list_(file: Path | None, as_json: bool) -> None:
    """List users and their roles.

    \b
    Example:
      tms user list
    """
    rows = [
        {"name": name, "role": user["role"], "by": "token" if user.get("token") else "password"}
        for name, user in _read(_path(file)).items()
    ]
    if as_json:
        session.show_json(rows)
        return
    for row in rows:
        click.echo(f"{row['name']:<20} {row['role']:<10} {row['by']}")


@command.command()
@click.argument("name")
@file_option
@session.json_option
def rm(name: str, file: Path | None, as_json: bool) -> None:
    """Remove a user.

    \b
    Example:
      tms user rm mina
    """
    path = _path(file)
    users = _read(path)
    if users.pop(name, None) is None:
        raise TmsError(NoUser(str(path), name))
    _write(path, users)
    if as_json:
        session.show_json({"removed": name})
    else:
        click.echo(f"{name} removed; `tms restart tms:ur` lets the console know")


def _path(file: Path | None) -> Path:
    if file is not None:
        return file
    site = session.site()
    if site.file.console.users is None:
        raise TmsError(NoUsersKey(str(site.path)))
    return site.path.parent / site.file.console.users


def _read(path: Path) -> dict[str, Any]:
    from tms_ur.access import Users

    return parse(path, Users).model_dump(exclude_none=True)["users"]  # type: ignore[no-any-return]


def _write(path: Path, users: dict[str, Any]) -> None:
    """Write the file in one step, readable for this user only."""
    path.parent.mkdir(parents=True, exist_ok=True)
    new = path.with_suffix(".new")
    new.touch(mode=0o600)
    new.chmod(0o600)
    new.write_text(yaml.safe_dump({"users": users}, sort_keys=True), encoding="utf-8")
    new.replace(path)
