"""Receipts are on the disk before they are told, and told again after a restart."""

from pathlib import Path

from tms_rc.receipts import KEPT, ROOM, Receipts


def test_the_last_ones_are_kept(tmp_path: Path) -> None:
    receipts = Receipts(tmp_path, "zx200")
    for number in range(ROOM + 3 * KEPT):
        receipts.keep(b"receipt %d" % number)
    found = Receipts(tmp_path, "zx200").all()
    assert found == receipts.all()
    assert found[-1] == b"receipt %d" % (ROOM + 3 * KEPT - 1) and len(found) == KEPT
    assert len((tmp_path / "rc" / "zx200.receipts").read_bytes().splitlines()) <= ROOM


def test_a_line_that_was_cut_spoils_no_other(tmp_path: Path) -> None:
    Receipts(tmp_path, "zx200").keep(b"one")
    path = tmp_path / "rc" / "zx200.receipts"
    path.write_bytes(path.read_bytes() + b"dHd")
    receipts = Receipts(tmp_path, "zx200")
    assert receipts.all() == [b"one"]
    receipts.keep(b"two")
    assert Receipts(tmp_path, "zx200").all() == [b"one", b"two"]
