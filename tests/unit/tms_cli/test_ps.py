"""`tms ps`: what each process of the table is for, in the language of the user."""

from collections.abc import Callable
from types import SimpleNamespace

import pytest
from click.testing import Result

from tms_cli.commands import ps
from tms_config.config import load_site
from tms_config.processes import table
from tms_host.supervisor import Running
from words import english

GONE = Running("zx200:old", "RUNNING", 7, 65.0, "")


@pytest.fixture
def listed(tms: Callable[..., Result], monkeypatch: pytest.MonkeyPatch) -> Callable[[str], dict[str, str]]:
    """The purposes by process in a language, as the command prints them; one process is not in the table any more."""
    running = [Running(row.full, "RUNNING", 7, 5.0, "") for row in table(load_site())]
    monkeypatch.setattr(ps, "Supervisor", lambda site: SimpleNamespace(processes=lambda: [*running, GONE]))

    def purposes(locale: str) -> dict[str, str]:
        monkeypatch.setenv("LC_ALL", locale)
        result = tms(ps.command)
        assert result.exit_code == 0, result.output
        head, *rows = result.output.splitlines()
        return {row.split()[0]: row[head.index("PURPOSE") :] for row in rows}

    return purposes


def test_an_engineer_reads_what_a_process_is_for(listed: Callable[[str], dict[str, str]]) -> None:
    found = listed("C.UTF-8")
    assert found["tms:ts"] == "runs tasks: the behaviour-tree scheduler"
    assert found["sim:zx200"] == "stand-in for zx200"
    assert found["zx200:st_zx200_navigate_anywhere_deg"] == "subtask navigate_anywhere"
    assert found[GONE.name] == "not in the site file any more"


def test_a_japanese_one_reads_no_english(listed: Callable[[str], dict[str, str]]) -> None:
    found = listed("ja_JP.UTF-8")
    assert found["tms:ur"] == "HTTP API とコンソール" and found["sim:zx200"] == "zx200 の模擬機"
    assert found["zx200:st_zx200_navigate_anywhere_deg"] == "サブタスク navigate_anywhere"
    assert [text for text in found.values() if english(text) or text.isascii()] == []
