"""One file brings the project to a PC without internet: it is installed there by one command, and its mesh works."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest
import yaml

from conftest import NO_CONSOLE, PROJECT, ports_of, site_data, tool

pytestmark = [pytest.mark.docker, pytest.mark.turns, pytest.mark.timeout(600, func_only=True)]
INSTALL = "ip link set lo up && make setup && tms up && tms rearm --all --yes && tms status && tms down"


def run(*argv: str, cwd: Path, env: dict[str, str]) -> str:
    done = subprocess.run(argv, cwd=cwd, env=env, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    return done.stdout


def test_a_bundle_is_installed_without_a_network(tmp_path: Path, own_domain: int) -> None:
    usual = {name: os.environ[name] for name in ("PATH", "HOME")}
    packed = run("make", "--silent", "bundle", f"OUT={tmp_path}", "STORE=1", cwd=PROJECT, env=dict(os.environ))
    file = Path(packed.strip().splitlines()[-1])
    run("sha256sum", "--check", f"{file.name}.sha256", cwd=tmp_path, env=usual)
    run("tar", "--extract", "--file", file.name, cwd=tmp_path, env=usual)
    there = tmp_path / file.stem
    site = tmp_path / "site.yaml"
    site.write_text(yaml.safe_dump(site_data(own_domain, ports_of(own_domain), **NO_CONSOLE)))
    env = {
        "HOME": str(tmp_path),  # no cache of this PC's
        "PATH": f"{there}/.venv/bin:{usual['PATH']}",
        "TMS_SITE": str(site),
        "TMS_STATE": str(tmp_path / "state"),
    }
    try:
        told = run(tool("unshare"), "--net", "sh", "-euc", INSTALL, cwd=there, env=env)
        assert "zx200:rc" in told
    finally:
        shutil.rmtree(there)
        file.unlink()
