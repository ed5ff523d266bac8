"""The latch outlives the gateway."""

from pathlib import Path

from tms_rc.memory import Memory


def test_the_cause_is_kept(tmp_path: Path) -> None:
    assert Memory(tmp_path, "zx200").read() == ""
    Memory(tmp_path, "zx200").write("software stop")
    assert Memory(tmp_path, "zx200").read() == "software stop"
    assert Memory(tmp_path, "ic120").read() == ""
    Memory(tmp_path, "zx200").write("")
    assert Memory(tmp_path, "zx200").read() == ""


def test_a_note_that_cannot_be_read_latches(tmp_path: Path) -> None:
    Memory(tmp_path, "zx200").write("x")
    (tmp_path / "rc" / "zx200.json").write_text("{")
    assert "cannot be read" in Memory(tmp_path, "zx200").read()
