"""`tms rearm`: the cause is told before anybody is asked, as the alert TmsLatchHeld and the site guide say."""

import json
from typing import Any

import pytest
from click.testing import CliRunner
from tms_msg_rc.srv import Rearm

from tms_cli.commands import rearm
from tms_decision.reasons import NotStopped
from tms_reason.errors import TmsError
from tms_ur import gateway_areas


@pytest.mark.parametrize(("answer", "steps"), [("n\n", [""]), ("y\n", ["", "t1"])])
def test_the_cause_is_told_before_the_question(
    mesh: Any, monkeypatch: pytest.MonkeyPatch, answer: str, steps: list[str]
) -> None:
    monkeypatch.delenv("TMS_SITE", raising=False)
    monkeypatch.setenv("LC_ALL", "C.UTF-8")
    mesh.answers["/zx200/rearm"] = Rearm.Response(token="t1", cause="software stop by mina")
    end = CliRunner().invoke(rearm.command, ["zx200"], input=answer)
    assert 0 <= end.stderr.index("software stop by mina") < end.stderr.index("Is it safe")
    assert [fields["token"] for _, fields in mesh.asked] == steps


def test_a_machine_is_let_back_once_it_is_armed(mesh: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("TMS_SITE", raising=False)
    steps: list[str] = []
    mesh.answers["/zx200/rearm"] = lambda token: steps.append(f"rearm {token}") or Rearm.Response(token="t1")
    monkeypatch.setattr(gateway_areas, "let_back", lambda _, machine, who: steps.append(f"{machine} by {who}"))
    end = CliRunner().invoke(rearm.command, ["zx200", "--escape", "--by", "mina", "--yes", "--json"])
    assert steps == ["rearm ", "rearm t1", "zx200 by mina"] and json.loads(end.stdout)["escape"] == "mina"
    mesh.answers["/zx200/rearm"] = TmsError(NotStopped("zx200"), "NOT_STOPPED")
    assert CliRunner().invoke(rearm.command, ["zx200", "--escape", "--by", "mina"]).exit_code == 0
    assert steps[3:] == ["zx200 by mina"]
    assert CliRunner().invoke(rearm.command, ["--all", "--escape"]).exit_code == 2
