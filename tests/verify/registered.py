"""What is there before anything runs: the documents of the store, the registration, Groot's files, the borders."""

from __future__ import annotations

import re
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import yaml
from lxml import etree

from conftest import PROJECT
from tms_config.config import load_site
from verify.place import MACHINE, Place
from verify.report import Book

FILE = PROJECT / "configs" / "tasks" / "verification.xml"
TASK_FIELDS = {"task_id", "type", "model_name", "description", "task_sequence"}  # Table 1
RECORD_FIELDS = {"model_name", "record_name", "type", "description"}  # Table 2, and the values
PORTS = {"model_name", "record_name", "subtask_name"}
LIMIT = 60  # s for the registration


def register(book: Book, place: Place) -> int:
    """Store the task as the paper's node does; the number of the task."""
    words = ["-m", "tms_db.task_generator", "--ros-args", "-p", f"bt_tree_xml_file_name:={FILE.stem}"]
    done = subprocess.run(
        [sys.executable, *words], capture_output=True, text=True, timeout=LIMIT, check=False, env=place.mesh.env
    )
    (number,) = re.findall(r"^task (\d+)$", done.stdout, re.MULTILINE) or [0]
    again = place.json("task", "add", str(FILE))
    with place.store() as store:
        document = store["task"].find_one({"task_id": int(number)}) or {}
        records = list(store["parameter"].find())
    same = again["task_id"] == int(number) and again["already_stored"]
    book.check(2, f"bt_tree_xml_file_name:={FILE.stem} became task {number}; a second time it is found again", same)
    added = {name: document.get(name) for name in ("task_id", "model_name", "description", "added_at")}
    told = ", ".join(f"{name} {value}" for name, value in added.items())
    book.check(2, f"added to the file: {told}", added["model_name"] == MACHINE and None not in added.values())
    _documents(book, document, records)
    return int(number)


def _documents(book: Book, task: dict[str, Any], records: list[dict[str, Any]]) -> None:
    lacking = sorted(TASK_FIELDS - task.keys())
    whole = task.get("task_sequence", "").strip() == FILE.read_text(encoding="utf-8").strip()
    book.check(1, f"document of the task with {', '.join(task)}, lacking {len(lacking)}", whole and not lacking)
    poor = [record for record in records if not RECORD_FIELDS <= record.keys()]
    kinds = [record.get("type") for record in records]
    told = (
        f"{len(records)} records: {kinds.count('static')} static, {kinds.count('dynamic')} dynamic, lacking {len(poor)}"
    )
    book.check(1, told, bool(records) and not poor and set(kinds) == {"static", "dynamic"})


def groot_files(book: Book, place: Place) -> None:
    """The palette for Groot, and what the user draws with it."""
    palette = etree.fromstring(place.json("palette")["palette"])
    every = [model for model in palette.iter("Action") if model.get("ID", "").startswith("LeafNode")]
    # The paper is of version 5; what version 6 has instead is marked in the texts of its ports.
    leaves = [leaf for leaf in every if not any((port.text or "").endswith("(version 6)") for port in leaf)]
    short = [str(leaf.get("ID")) for leaf in leaves if {port.get("name") for port in leaf} != PORTS]
    drawn = [node for node in etree.parse(FILE).iter("Action") if node.get("model_name")]
    known = {model.get("ID") for model in palette.iter("Action")}
    errors = place.json("task", "check", str(FILE))["errors"]
    told = f"palette of {len(list(palette.iter('{*}input_port', '{*}inout_port')))} ports, {len(leaves)} leaf nodes"
    book.check(3, told, bool(leaves) and {node.get("ID") for node in drawn} <= known)
    book.check(3, f"{FILE.name}, as Groot writes it, has {len(errors)} errors", not errors)
    told = (
        f"{len(leaves)} leaf nodes in the palette, {len(leaves) - len(short)} with exactly {', '.join(sorted(PORTS))}"
        f" ({len(every) - len(leaves)} more of version 6)"
    )
    book.check(7, told, bool(leaves) and not short)
    more = {name for node in drawn for name in node.keys()} - PORTS - {"ID", "name"}
    book.check(7, f"{len(drawn)} leaves drawn with {len(more)} attributes but these names", bool(drawn) and not more)


def borders(book: Book, place: Place) -> None:
    """The same machine behind OPERA's border: what its gateway would use there. No real machine is here."""
    data = yaml.safe_load(place.site.path.read_text(encoding="utf-8")) | {"backend": "opera"}
    del data["services"]["if"]
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "site.yaml")
        file.write_text(yaml.safe_dump(data))
        checked = place.mesh.tms("--site", str(file), "check", expect=None).returncode == 0
        border = load_site(str(file)).border(MACHINE)
    names = [border.trajectory, border.joint_states, border.odom, border.cmd_vel, border.emg_stop]
    told = f"OPERA: the site passes `tms check`, {len(list(filter(None, names)))} names of its border (no machine here)"
    book.check(12, told, checked and border.trajectory is not None)
