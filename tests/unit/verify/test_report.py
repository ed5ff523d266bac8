"""The table of the verification."""

import json
from pathlib import Path

from verify import report
from verify.report import NOT_REACHED, REQUIREMENTS, Book


def full() -> Book:
    book = Book()
    for number in REQUIREMENTS:
        book.note(number, f"{number} ms")
    return book


def test_all_measured_and_right_is_success() -> None:
    rows = full().rows(unfinished=False)
    assert [row.number for row in rows] == list(range(1, 14))
    assert report.exit_code(rows) == 0


def test_a_requirement_without_a_figure_fails() -> None:
    rows = Book().rows(unfinished=False)
    assert {row.problems for row in rows} == {(NOT_REACHED,)}
    assert report.exit_code(rows) == 1


def test_one_wrong_figure_fails() -> None:
    book = full()
    book.check(7, "8 leaves, 7 with their names", False)
    rows = book.rows(unfinished=False)
    assert [row.number for row in rows if not row.held] == [7]
    assert report.exit_code(rows) == 1


def test_a_scenario_that_broke_off_fails() -> None:
    assert report.exit_code(full().rows(unfinished=True)) == 1


def test_files_name_the_commit_and_every_figure(tmp_path: Path) -> None:
    book = full()
    book.note(10, "stood | after 1.2 s", ["it crept"])
    rows = book.rows(unfinished=False)
    report.write(tmp_path, rows, "abc123", "2026-01-01", 12.34)
    whole = json.loads((tmp_path / "verification.json").read_text())
    assert (whole["commit"], whole["seconds"]) == ("abc123", 12.3)
    assert whole["rows"][9]["measured"] == ["10 ms", "stood | after 1.2 s"]
    assert [row["number"] for row in whole["rows"] if not row["held"]] == [10]
    text = (tmp_path / "verification.md").read_text()
    assert "`abc123`" in text
    assert "stood \\| after 1.2 s<br>**wrong: it crept** | **FAILS** |" in text
    assert "WRONG: it crept" in report.terminal(rows)
