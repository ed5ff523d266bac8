"""`tms rearm`: the cause is told before anybody is asked, as the alert TmsLatchHeld and the site guide say."""

from typing import Any

import pytest
from click.testing import CliRunner
from tms_msg_rc.srv import Rearm

from tms_cli.commands import rearm


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
