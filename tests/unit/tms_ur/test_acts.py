"""Acts that gateways tell of are in the audit once, also after a restart of the console."""

import threading
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from builtin_interfaces.msg import Time
from tms_msg_db.msg import Event

from tms_ur.acts import Acts


class Audit:
    def __init__(self) -> None:
        self.notes: list[tuple[str, ...]] = []

    def put(self, *note: str) -> threading.Event:
        self.notes.append(note)
        kept = threading.Event()
        kept.set()
        return kept


def acts(audit: Audit, folder: Path) -> Acts:
    ros: Any = SimpleNamespace(subscribe=lambda *_, **__: None, begin=lambda *_: None)
    heard: Any = audit
    return Acts(ros, heard, folder / "audit.acts", ["zx200", "ic120"])


def act(sec: int, kind: str = "enable_areas") -> Event:
    return Event(stamp=Time(sec=sec), kind=kind, node="zx200 1234", text="T. Yamada")


def test_each_act_has_one_entry(tmp_path: Path) -> None:
    audit = Audit()
    made = acts(audit, tmp_path)
    for one in (act(7), act(7), act(9), act(8)):  # a clock may go back
        made.note("zx200", one)
    made.note("ic120", act(7))
    made.note("zx200", act(10, "make_tea"))
    entry = ("T. Yamada", "zx200:rc", "enable_areas", "zx200 1234")
    assert audit.notes == [entry] * 3 + [("T. Yamada", "ic120:rc", *entry[2:])]
    made = acts(audit, tmp_path)
    made.note("zx200", act(8))
    made.note("zx200", act(11, "escape"))
    assert len(audit.notes) == 5


def test_a_damaged_file_costs_second_entries_only(tmp_path: Path) -> None:
    for damage in ("[]", "{", '{"zx200": 7}', '{"zx200": [[1]]}'):
        audit = Audit()
        (tmp_path / "audit.acts").write_text(damage)
        acts(audit, tmp_path).note("zx200", act(7))
        assert len(audit.notes) == 1
