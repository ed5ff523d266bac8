"""Prometheus' folder for a site: its configuration, the rules, and the targets of the process table."""

import json
import os
import re
from pathlib import Path

from tms_cli.reasons import NoHostPort, NotWritable
from tms_config.config import PROJECT, Site
from tms_config.processes import table
from tms_reason.errors import ConfigError
from tms_runtime import state_folder

SOURCE = PROJECT / "deploy" / "prometheus"
COPIED = ("prometheus.yml", "rules.yml")
HOST_PORT = re.compile(r"(\[[0-9A-Fa-f:.]+\]|[0-9A-Za-z._-]+):([0-9]{1,5})")


def folder(site: Site) -> Path:
    """Prometheus' folder: TMS_PROMETHEUS, or one in the state folder, which only this user can read."""
    return Path(os.environ.get("TMS_PROMETHEUS") or site.state / "prometheus").resolve()


def targets(site: Site) -> list[dict[str, object]]:
    """One entry a process, in the form of Prometheus' file_sd; all PCs of the site."""
    return [
        {
            "targets": [f"{row.address}:{row.port}"],
            "labels": {
                "site": site.name,
                "process": row.full,
                "role": row.role,
                "machine": row.machine or "",
                "pc": row.pc,
                "on_demand": "no" if row.autostart else "yes",
            },
        }
        for row in table(site)
        if row.ours
    ]


def render(site: Site, folder: Path, alertmanager: str | None = None) -> None:
    """Write everything that `prometheus --config.file=FOLDER/prometheus.yml` reads; it notices new targets itself.

    Outside the state folder Prometheus' own user may read it: it holds no secrets.

    Raises:
        ConfigError: the folder cannot be written, or `alertmanager` is no HOST:PORT (Prometheus would not start).
    """
    if alertmanager:
        _check(alertmanager)
    try:
        shared = not folder.is_relative_to(site.state)
        if not shared:
            state_folder.make(site.state)
        folder.mkdir(mode=0o755 if shared else 0o700, parents=True, exist_ok=True)
        texts = {name: (SOURCE / name).read_text(encoding="utf-8") for name in COPIED}
        texts["targets.json"] = json.dumps(targets(site), indent=1)
        if alertmanager or not (folder / "alertmanagers.json").exists():
            texts["alertmanagers.json"] = json.dumps([{"targets": [alertmanager]}] if alertmanager else [])
        for name, text in texts.items():
            _replace(folder / name, text, 0o644 if shared else 0o600)
    except OSError as error:
        raise ConfigError(NotWritable(str(folder), str(error.strerror))) from error


def _check(alertmanager: str) -> None:
    found = HOST_PORT.fullmatch(alertmanager)
    if found is None or not 0 < int(found[2]) < 65536:
        raise ConfigError(NoHostPort(alertmanager))


def _replace(path: Path, text: str, mode: int) -> None:
    """Replace a file in one step, since Prometheus may read it at any moment."""
    new = path.with_suffix(".new")
    new.write_text(text, encoding="utf-8")
    new.chmod(mode)
    new.replace(path)
