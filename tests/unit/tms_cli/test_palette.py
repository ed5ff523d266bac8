"""`tms palette`: on stdout, in a file, always the same."""

import json
from pathlib import Path

from lxml import etree

from tms_cli.commands import palette
from tms_reason.errors import TmsError
from tms_ts.bt import registry


def test_it_is_what_groot_1_imports(tms) -> None:
    text = tms(palette.command).stdout
    root = etree.fromstring(text)
    assert root.tag == "root"
    (model,) = root
    assert model.tag == "TreeNodesModel"
    entries = [entry for entry in model if isinstance(entry.tag, str)]
    assert {entry.tag for entry in entries} <= {"Action", "Condition", "Control", "Decorator"}
    assert not {entry.get("ID") for entry in entries} & {name for name, cls in registry().items() if cls.builtin}
    ports = [port for entry in entries for port in entry]
    assert {port.tag for port in ports} <= {"input_port", "output_port", "inout_port"}
    assert all(port.get("name") == port.get("name").strip() != "" for port in ports)
    assert text.isascii()


def test_a_file_holds_the_same_every_time(tms, tmp_path: Path) -> None:
    file = tmp_path / "palette.xml"
    end = tms(palette.command, "-o", file)
    assert (end.exit_code, end.stdout) == (0, "")
    assert str(file) in end.stderr
    assert file.read_text() == tms(palette.command).stdout
    document = json.loads(tms(palette.command, "--output", file, "--json").stdout)
    assert document == {"palette": file.read_text(), "file": str(file)}


def test_a_file_that_cannot_be_written_is_told(tms, tmp_path: Path) -> None:
    error = tms(palette.command, "-o", tmp_path / "no/palette.xml").exception
    assert isinstance(error, TmsError)
    assert "cannot be written" in str(error)
