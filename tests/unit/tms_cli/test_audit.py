"""`tms audit`: the newest entries, and what is wrong with the chain."""

import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from builtin_interfaces.msg import Time
from tms_msg_db.msg import Event
from tms_msg_db.srv import ListEvents

from tms_cli import session
from tms_cli.commands import audit
from tms_machine.values import to_parameters
from tms_reason.errors import TmsError
from tms_reason.reason import Foreign
from tms_ur.audit_chain import ChainHead, Note, tied
from tms_ur.audit_ledger import Ledger

NOTES = [Note(1_790_000_000_000 + number, "stop", f"target {number}", "mina from 192.0.2.1", 1) for number in range(5)]
CHAIN = tied(ChainHead(0, ""), [*NOTES[:4], Note(NOTES[4].at, "refused", "LOGIN", "- from 192.0.2.9", 12)])


def events() -> list[Event]:
    return [_event(one.number, one.note, one.values()) for one in CHAIN]


def _event(number: int, note: Note, values: dict[str, Any]) -> Event:
    stamp = Time(sec=note.at // 1000, nanosec=note.at % 1000 * 10**6)
    facts = {"kind": note.kind, "node": note.node, "text": note.text, "values": to_parameters(values)}
    return Event(run_id="audit", number=number, stamp=stamp, **facts)


def database(stored: list[Event]) -> Any:
    def list_events(run_id: str, after: int, limit: int) -> Any:
        assert run_id == "audit"
        found = [event for event in stored if event.number > after][:limit]
        return ListEvents.Response(events=found) if found else TmsError(Foreign("none"), "RUN_MISSING")

    return list_events


@pytest.fixture
def site(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    monkeypatch.setattr(session, "site", lambda: SimpleNamespace(state=tmp_path))
    return tmp_path


def test_an_intact_chain(mesh, tms, site) -> None:
    mesh.answers["/tms/db/list_events"] = database(events())
    result = tms(audit.verify)
    assert (result.exit_code, "intact: 5 entries, the last one is 5" in result.output) == (0, True)
    assert "does not run on this PC" in result.output
    report = json.loads(tms(audit.verify, "--json").stdout)
    assert (report["intact"], report["entries"], report["end_compared"], report["faults"]) == (True, 5, False, [])


def test_an_empty_database(mesh, tms, site) -> None:
    mesh.answers["/tms/db/list_events"] = database([])
    assert tms(audit.verify).exit_code == 0
    assert "no command was given" in tms(audit.list_).output


@pytest.mark.parametrize(
    ("damage", "reported"),
    [
        (lambda stored: stored.pop(2), "entries 3 to 3 are missing"),
        (lambda stored: setattr(stored[1], "text", "ken from 192.0.2.1"), "entry 2 was changed"),
        (lambda stored: stored[3].values.clear(), "entry 4 has no hash"),
    ],
)
def test_a_damaged_chain(mesh, tms, site, damage, reported) -> None:
    stored = events()
    damage(stored)
    mesh.answers["/tms/db/list_events"] = database(stored)
    result = tms(audit.verify)
    assert result.exit_code == 1
    assert reported in result.output
    assert "NOT intact" in result.output


def test_an_end_that_the_console_remembers(mesh, tms, site) -> None:
    ledger = Ledger(site / "audit.db")
    ledger.move(ChainHead(4, CHAIN[3].hash))
    ledger.close()
    mesh.answers["/tms/db/list_events"] = database(events())  # one more was stored since
    assert json.loads(tms(audit.verify, "--json").stdout)["end_compared"]
    mesh.answers["/tms/db/list_events"] = database(events()[:3])
    result = tms(audit.verify)
    assert (result.exit_code, "entries 4 to 4 are missing" in result.output) == (1, True)


def test_an_unreadable_file_of_the_console(mesh, tms, site) -> None:
    (site / "audit.db").write_bytes(b"no database" * 1000)
    result = tms(audit.verify)
    assert isinstance(result.exception, TmsError)
    assert "audit.db cannot be read" in str(result.exception)


def test_the_newest_are_listed(mesh, tms) -> None:
    mesh.answers["/tms/db/list_events"] = database(events())
    lines = tms(audit.list_, "--limit", "2").output.splitlines()
    assert len(lines) == 2
    assert "target 3" in lines[0]
    assert lines[1].endswith("- from 192.0.2.9  ×12")
    assert [row["number"] for row in json.loads(tms(audit.list_, "--json").stdout)] == [1, 2, 3, 4, 5]
