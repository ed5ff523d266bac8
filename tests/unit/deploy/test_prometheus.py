"""Rules and configuration with Prometheus' own checker, and that nothing asks for metrics that nobody has."""

import json
import re
import subprocess
from pathlib import Path

import pytest
from click.testing import CliRunner

from conftest import PROJECT, tool
from tms_cli import monitoring
from tms_cli.commands import prometheus
from tms_config.config import load_site
from tms_config.processes import table
from tms_reason.errors import ConfigError

FOLDER = PROJECT / "deploy" / "prometheus"
DASHBOARDS = sorted((PROJECT / "deploy" / "grafana" / "dashboards").glob("*.json"))


def check(*argv: str, cwd: Path = FOLDER) -> None:
    done = subprocess.run([tool("promtool"), *argv], cwd=cwd, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_rules_fire_when_they_must_and_only_then() -> None:
    check("test", "rules", "rules_test.yml")


def test_the_rendered_configuration_is_valid(tmp_path: Path) -> None:
    monitoring.render(load_site(), tmp_path, alertmanager="127.0.0.1:9093")
    check("check", "config", "prometheus.yml", cwd=tmp_path)


def test_the_example_of_the_alertmanager_is_valid() -> None:
    argv = [tool("amtool"), "check-config", str(FOLDER / "alertmanager.example.yml")]
    done = subprocess.run(argv, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stderr


def test_every_process_with_metrics_is_a_target_with_its_labels() -> None:
    site = load_site()
    found = {str(t["labels"]["process"]): t for t in monitoring.targets(site)}  # type: ignore[index]
    assert set(found) == {row.full for row in table(site) if row.ours}
    rc = found["zx200:rc"]
    assert rc["labels"] == {
        "site": "demo", "process": "zx200:rc", "role": "machine", "machine": "zx200", "pc": "", "on_demand": "no",
    }  # fmt: skip


def test_a_chosen_alertmanager_outlives_the_next_start(tmp_path: Path) -> None:
    site = load_site()
    monitoring.render(site, tmp_path, alertmanager="10.0.0.9:9093")
    monitoring.render(site, tmp_path)
    assert json.loads((tmp_path / "alertmanagers.json").read_text()) == [{"targets": ["10.0.0.9:9093"]}]


@pytest.mark.parametrize(
    "wrong", ["alerts", "http://alerts:9093", "alerts:", ":9093", "alerts:0", "alerts:65536", "a b:1"]
)
def test_an_address_that_prometheus_would_not_start_with_is_refused(tmp_path: Path, wrong: str) -> None:
    with pytest.raises(ConfigError, match="HOST:PORT"):
        monitoring.render(load_site(), tmp_path, alertmanager=wrong)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("right", ["127.0.0.1:9093", "alerts.example:80", "[fd00::1]:9093"])
def test_an_alertmanager_by_number_or_name(tmp_path: Path, right: str) -> None:
    monitoring.render(load_site(), tmp_path, alertmanager=right)
    assert json.loads((tmp_path / "alertmanagers.json").read_text()) == [{"targets": [right]}]


def test_the_alertmanager_may_come_by_environment(tmp_path: Path) -> None:
    argv = ["-o", str(tmp_path)]
    CliRunner().invoke(prometheus.command, argv, env={"TMS_ALERTS_TO": "10.0.0.9:9093"}, catch_exceptions=False)
    assert json.loads((tmp_path / "alertmanagers.json").read_text()) == [{"targets": ["10.0.0.9:9093"]}]


def test_every_alert_is_tried_and_speaks_both_languages() -> None:
    rules = (FOLDER / "rules.yml").read_text(encoding="utf-8")
    tried = (FOLDER / "rules_test.yml").read_text(encoding="utf-8")
    alerts = re.findall(r"- alert: (\w+)", rules)
    assert alerts and [name for name in alerts if name not in tried] == []
    for kind in ("summary:", "summary_ja:", "action:", "severity:"):
        assert rules.count(kind) == len(alerts), kind


def test_dashboards_have_their_own_names_and_the_provisioned_source() -> None:
    boards = [json.loads(path.read_text(encoding="utf-8")) for path in DASHBOARDS]
    assert [board["uid"] for board in boards] == [path.stem for path in DASHBOARDS]
    assert {panel["datasource"]["uid"] for board in boards for panel in board["panels"]} == {"tms"}
    assert len(boards) == 5 and all(board["panels"] for board in boards)


def test_what_dashboards_ask_for_is_promql(tmp_path: Path) -> None:
    asked = [
        target["expr"].replace("$__range", "1h").replace("$machine", ".*")
        for path in DASHBOARDS
        for panel in json.loads(path.read_text(encoding="utf-8"))["panels"]
        for target in panel["targets"]
    ]
    assert len(asked) > 40 and not [one for one in asked if "$" in one]
    rules = [{"record": f"tms:panel:{number}", "expr": one} for number, one in enumerate(asked)]
    (tmp_path / "panels.yml").write_text(json.dumps({"groups": [{"name": "panels", "rules": rules}]}))
    check("check", "rules", "panels.yml", cwd=tmp_path)
