"""A machine is armed while its note says so; whatever else is found means latched."""

import json
from pathlib import Path
from typing import Any

import pytest

from tms_config.clock import unix_ns
from tms_decision.reasons import NoNote, SoftwareStop
from tms_host.pressed_notes import press
from tms_rc.latch_file import LatchFile, Left
from tms_rc.reasons import NoteUnreadable
from tms_rc.receipts import Receipts
from tms_reason.reason import Foreign
from tms_runtime.state_folder import armed_note


def test_a_machine_without_a_note_is_latched(tmp_path: Path) -> None:
    assert LatchFile(tmp_path, "zx200").read() == Left(NoNote())


def test_armed_is_what_the_note_says(tmp_path: Path) -> None:
    LatchFile(tmp_path, "zx200").arm()
    assert LatchFile(tmp_path, "zx200").read() == Left(None)
    assert LatchFile(tmp_path, "ic120").read() == Left(NoNote())


def test_the_run_that_may_have_left_it_moving_is_told(tmp_path: Path) -> None:
    LatchFile(tmp_path, "zx200").arm("20261122-1", 7)
    assert LatchFile(tmp_path, "zx200").read() == Left(None, "20261122-1", 7)


def test_a_latch_and_its_cause_are_kept(tmp_path: Path) -> None:
    memory = LatchFile(tmp_path, "zx200")
    memory.arm("20261122-1", 7)
    memory.latch(SoftwareStop())
    assert LatchFile(tmp_path, "zx200").read() == Left(SoftwareStop(), unproven=True)
    memory.arm()
    assert LatchFile(tmp_path, "zx200").read() == Left(None)


def test_a_latch_whose_receipt_never_came_is_unproven(tmp_path: Path) -> None:
    memory = LatchFile(tmp_path, "zx200")
    memory.latch(SoftwareStop())
    assert memory.read().unproven
    Receipts(tmp_path, "zx200").keep(b"receipt")
    assert not memory.read().unproven


def test_who_drives_by_hand_is_kept(tmp_path: Path) -> None:
    memory = LatchFile(tmp_path, "zx200")
    memory.arm()
    memory.take("mina")
    assert LatchFile(tmp_path, "zx200").read() == Left(None, taken="mina")
    memory.take("")
    assert LatchFile(tmp_path, "zx200").read() == Left(None)


@pytest.mark.parametrize(
    "torn",
    ["", "{", '{"armed": tr', "[]", '{"armed": 1}', '{"armed": true}', '{"armed": true, "holder": ""}', "\0\0\0"],
)
def test_a_torn_note_latches(tmp_path: Path, torn: str) -> None:
    memory = LatchFile(tmp_path, "zx200")
    memory.arm()
    (tmp_path / "rc" / "zx200.armed").write_text(torn)
    assert memory.read() == Left(NoteUnreadable())


def test_a_note_that_may_not_be_read_latches(tmp_path: Path) -> None:
    (tmp_path / "rc" / "zx200.armed").mkdir(parents=True)
    assert LatchFile(tmp_path, "zx200").read() == Left(NoteUnreadable())


def full_disk(monkeypatch: pytest.MonkeyPatch) -> None:
    def fails(*_: Any) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("tms_runtime.durable.write_all", fails)


def test_a_full_disk_latches_all_the_same(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The note is taken away; only the cause finds no room."""
    memory = LatchFile(tmp_path, "zx200")
    memory.arm()
    full_disk(monkeypatch)
    memory.latch(SoftwareStop())
    assert LatchFile(tmp_path, "zx200").read() == Left(NoNote())


def test_a_full_disk_arms_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    memory = LatchFile(tmp_path, "zx200")
    memory.arm()
    memory.latch(SoftwareStop())
    full_disk(monkeypatch)
    with pytest.raises(OSError, match="No space left"):
        memory.arm()
    monkeypatch.undo()
    assert LatchFile(tmp_path, "zx200").read() == Left(SoftwareStop(), unproven=True)


def test_a_crash_while_it_is_written_leaves_the_old_note(tmp_path: Path) -> None:
    memory = LatchFile(tmp_path, "zx200")
    memory.latch(SoftwareStop())
    (tmp_path / "rc" / "zx200.armed.part").write_text(json.dumps({"armed": True, "holder": "", "run": 0}))
    assert memory.read() == Left(SoftwareStop(), unproven=True)


def test_a_note_of_an_earlier_release_keeps_its_words(tmp_path: Path) -> None:
    (tmp_path / "rc").mkdir()
    (tmp_path / "rc" / "zx200.latched").write_text(json.dumps({"cause": "software stop by mina"}))
    assert LatchFile(tmp_path, "zx200").read() == Left(Foreign("software stop by mina"), unproven=True)


def test_a_press_that_the_host_agent_has_noted_latches(tmp_path: Path) -> None:
    memory = LatchFile(tmp_path, "zx200")
    memory.arm("20261122-1", 7)
    press(armed_note(tmp_path, "zx200"), unix_ns())
    assert LatchFile(tmp_path, "zx200").read() == Left(SoftwareStop(), unproven=True)
    memory.arm()
    assert LatchFile(tmp_path, "zx200").read() == Left(None)
    press(armed_note(tmp_path, "zx200"), unix_ns())
    memory.latch(NoNote())
    assert LatchFile(tmp_path, "zx200").read().latched == NoNote()  # the gateway's own word is newer


def test_a_press_says_nothing_of_a_machine_that_was_armed_after_it(tmp_path: Path) -> None:
    before, memory = unix_ns() - 10**9, LatchFile(tmp_path, "zx200")  # the disk's clock is coarse
    press(armed_note(tmp_path, "zx200"), before)  # there is no note
    memory.arm()
    press(armed_note(tmp_path, "zx200"), before)
    assert LatchFile(tmp_path, "zx200").read() == Left(None)
