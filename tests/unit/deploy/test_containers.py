"""Image, compose files, firewall and unit with the checkers of those who made them; none of them starts anything."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

from conftest import PROJECT, tool
from tms_config.config import load_site
from tms_config.processes import table
from tms_config.site_file import ROLES

DEPLOY = PROJECT / "deploy"
COMPOSE = sorted(path for path in (DEPLOY / "compose").glob("*.yml") if path.stem != "base")

needs_root = pytest.mark.skipif(os.getuid() != 0, reason="nft checks only for root")


def run(*argv: str, **variables: str) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, **variables}
    return subprocess.run(argv, env=environment, capture_output=True, text=True, timeout=60, check=False)


def compose() -> list[str]:
    """The client of Compose that this PC has, a plugin of Docker's as `make` chooses it, or a program of its own."""
    debians = "/usr/bin/docker"
    docker = os.environ.get("DOCKER") or (debians if Path(debians).exists() else shutil.which("docker"))
    if docker and run(docker, "compose", "version").returncode == 0:
        return [docker, "compose"]
    return [tool("docker-compose")]


def test_the_image_is_as_hadolint_wants_it() -> None:
    done = run(str(Path(sys.executable).parent / "hadolint"), str(DEPLOY / "Dockerfile"))
    assert done.returncode == 0, done.stdout


def test_the_image_runs_as_nobody_special_and_without_the_gpl_store() -> None:
    text = (DEPLOY / "Dockerfile").read_text()
    last = text.rindex("\nFROM ")
    assert text[last:].strip() == "FROM site", "what is built without a target is the site's image"
    site = text[text.index("AS site") : text.index("AS demo")]
    assert "USER 990" in site and "venv-store" not in site


def test_every_role_has_a_compose_file() -> None:
    assert {path.stem for path in COMPOSE} == {*ROLES, "trial"}


def test_the_trial_has_a_container_at_the_address_of_each_pc() -> None:
    trial = yaml.safe_load((DEPLOY / "compose" / "trial.yml").read_text())
    here = {name: service["networks"]["site"]["ipv4_address"] for name, service in trial["services"].items()}
    assert here == {name: pc.address for name, pc in load_site("trial").file.pcs.items()}


@pytest.mark.parametrize("path", COMPOSE, ids=lambda path: path.stem)
def test_compose_reads_it(path: Path) -> None:
    argv = [*compose(), "-p", f"tms-{path.stem}", "-f", str(path), "config"]
    done = run(*argv, TMS_SITE_NAME="yard", TMS_PC=path.stem)
    assert done.returncode == 0 and not done.stderr.strip(), done.stderr
    services = yaml.safe_load(done.stdout)["services"]
    for name, service in services.items():
        assert service.get("restart") == "unless-stopped", f"{name}: restart"
        assert "mem_limit" in service, f"{name}: mem_limit"
        assert service.get("cap_drop") == ["ALL"], f"{name}: cap_drop"
        for published in service.get("ports", []):
            host = published.get("host_ip") if isinstance(published, dict) else str(published).split(":")[0]
            assert host == "127.0.0.1", f"{name}: {published} listens beyond loopback"


def test_a_role_without_a_site_is_refused() -> None:
    argv = [*compose(), "-f", str(DEPLOY / "compose" / "machine.yml"), "config"]
    done = run(*argv, TMS_SITE_NAME="", TMS_PC="")
    assert done.returncode != 0 and "TMS_" in done.stderr


def test_secrets_are_made_once_and_never_shown(tmp_path: Path) -> None:
    folder = tmp_path / "compose"
    folder.mkdir()
    script = shutil.copy(DEPLOY / "compose" / "secrets.sh", folder)
    first = run("sh", str(script))
    made = {path.name: path.read_text() for path in (folder / "secrets").iterdir()}
    assert set(made) == {"mongodb_password", "mongodb_key", "grafana_password", "mongodb_uri"}
    run("sh", str(script))
    assert {path.name: path.read_text() for path in (folder / "secrets").iterdir()} == made
    assert made["mongodb_password"] in made["mongodb_uri"] and made["mongodb_password"] not in first.stdout
    assert run("git", "-C", str(PROJECT), "check-ignore", "-q", "deploy/compose/secrets/x").returncode == 0
    assert (folder / "secrets").stat().st_mode & 0o777 == 0o700  # no other user of this PC gets to the files


def test_secrets_stay_out_of_the_image() -> None:
    rules = (PROJECT / ".dockerignore").read_text().split()  # the last rule that fits decides
    assert "deploy/compose/secrets" in rules[rules.index("!deploy") :]
    assert {"configs/**/users*", "configs/**/*.pem", "configs/**/*.key"} <= set(rules[rules.index("!configs") :])


@pytest.mark.parametrize("file", ["users.yaml", "users_genba.yaml", "users.new", "cert.pem", "tls/site.key"])
def test_who_may_use_a_console_and_its_key_stay_out_of_git(file: str) -> None:
    for folder in ("configs", "configs/sites"):  # beside the site file, wherever it is
        assert run("git", "-C", str(PROJECT), "check-ignore", "-q", f"{folder}/{file}").returncode == 0
    assert run("git", "-C", str(PROJECT), "check-ignore", "-q", "configs/sites/genba.yaml").returncode == 1


def test_alerts_go_to_the_alertmanager_beside_prometheus() -> None:
    services = yaml.safe_load((DEPLOY / "compose" / "cps.yml").read_text())["services"]
    to = services["tms"]["environment"]["TMS_ALERTS_TO"]
    assert f"--web.listen-address={to}" in services["alertmanager"]["command"]


@needs_root
def test_the_firewall_is_valid() -> None:
    done = run(tool("nft"), "-c", "-f", str(DEPLOY / "network" / "nftables.conf"))
    assert done.returncode == 0, done.stderr


@needs_root
def test_a_pc_that_is_taken_out_of_the_firewall_is_not_let_in_any_more(tmp_path: Path) -> None:
    """In a network namespace of its own, where nothing else is."""
    rules = (DEPLOY / "network" / "nftables.conf").read_text()
    many, few = tmp_path / "many", tmp_path / "few"
    many.write_text(rules.replace("10.77.0.1-10.77.0.250", "10.77.0.1, 10.77.0.66"))
    few.write_text(rules.replace("10.77.0.1-10.77.0.250", "10.77.0.1"))
    nft = tool("nft")
    done = run("unshare", "-n", "sh", "-ec", f"{nft} -f {many}; {nft} -f {few}; {nft} list ruleset")
    assert done.returncode == 0, done.stderr
    assert "10.77.0.1 " in done.stdout and "10.77.0.66" not in done.stdout
    assert done.stdout.count('iif "lo" accept') == 1


def test_the_firewall_lets_the_pcs_ask_the_cps_pc_for_the_time() -> None:
    rules = (DEPLOY / "network" / "nftables.conf").read_text()
    assert "iifname $site_interface ip saddr $site_pcs udp dport 123 accept" in rules


def test_the_example_site_is_right_and_listens_on_its_own_addresses_only() -> None:
    site = load_site("yard")
    usual = set(ROLES) - {"scheduler"}  # most sites need no second one
    assert set(site.file.pcs) == usual and site.file.bind == "127.0.0.1"
    assert next(row.pc for row in table(site) if row.full == "tms:sp") == "sensing"
