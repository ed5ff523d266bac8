"""The latch outlives the gateway."""

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from tms_rc.memory import Memory


def test_the_cause_is_kept(tmp_path: Path) -> None:
    assert Memory(tmp_path, "zx200").read() == ""
    Memory(tmp_path, "zx200").write(lambda: "software stop")
    assert Memory(tmp_path, "zx200").read() == "software stop"
    assert Memory(tmp_path, "ic120").read() == ""
    Memory(tmp_path, "zx200").write(lambda: "")
    assert Memory(tmp_path, "zx200").read() == ""


def test_a_note_that_cannot_be_read_latches(tmp_path: Path) -> None:
    Memory(tmp_path, "zx200").write(lambda: "x")
    (tmp_path / "rc" / "zx200.json").write_text("{")
    assert "cannot be read" in Memory(tmp_path, "zx200").read()


def test_stops_that_end_at_once_do_not_lose_the_note(tmp_path: Path) -> None:
    memory = Memory(tmp_path, "zx200")
    with ThreadPoolExecutor(8) as threads:
        list(threads.map(lambda _: memory.write(lambda: "software stop"), range(400)))
    assert memory.read() == "software stop"
