"""Grounds and cycles in the store, and the verbs that show them without any process."""

import csv
import io
import json
import re
import shutil
from collections.abc import Callable, Iterator
from datetime import datetime, timedelta, timezone
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import reportlab
from click.testing import CliRunner, Result
from PIL import Image
from tms_msg_db.msg import MachineState
from tms_msg_db.srv import ListCycles, WriteMachineStates

import height_files as files
from height_files import EAST, LEVEL, NORTH
from tms_cli.commands import ground, report, work
from tms_config.clock import utc_now
from tms_db import store
from tms_db.cycles import Cycles, checked
from tms_db.ground import GroundSnapshots
from tms_db.node import TaskServices
from tms_db.reasons import BadCycle, CycleUnreadable, GroundNotThere, GroundUnreadable
from tms_db.work_services import WorkServices
from tms_reason.errors import DbError
from tms_report import letters
from tms_report.map_picture import BOTTOM, LEFT, RIGHT, TOP
from tms_soil.surface import Heights
from tms_work.cycle import Cycle
from tms_work.reasons import EndsBeforeBegin

FLAT = Heights(-1.5, 2.0, 0.5, np.zeros((20, 40)))
DAY = datetime(2025, 11, 26).astimezone()


def cycle(number: int, hour: float, **more: Any) -> Cycle:
    begin = DAY + timedelta(hours=hour)
    parts = {"dig": 15.0, "swing_loaded": 10.0, "dump": 5.0, "swing_back": 8.0}
    facts = {"run_id": "run-1", "machine": "zx200", "number": number, "kind": "dig", "begun_at": begin,
             "ended_at": begin + timedelta(seconds=40), "parts": parts, "bank": 0.5, "loose": 0.625, "mass": 800.0,
             "fill": 0.8}  # fmt: skip
    return checked(facts | more)


def haul(number: int, hour: float) -> Cycle:
    parts = {"load": 100.0, "haul": 60.0, "tip": 20.0, "return": 50.0}
    return cycle(number, hour, machine="ic120_1", kind="haul", parts=parts, loose=5.0, fill=None, distance=400.0,
                 ended_at=DAY + timedelta(hours=hour, seconds=240))  # fmt: skip


def dug(depth: float) -> Heights:
    z = FLAT.z.copy()
    z[4:8, 10:20] = -depth
    return Heights(FLAT.x0, FLAT.y0, FLAT.cell, z)


@pytest.fixture
def tms(shared_db: store.Db, server: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., Result]:
    """Run a verb on the store of the test; the site's ground is that of the files of `height_files`."""
    site = tmp_path / "site.yaml"
    site.write_text(
        f"name: yard\ndomain: 43\nstore: {{database: {shared_db.name}}}\nservices: {{db: {{}}}}\n"
        f"ground:\n  origin: {{plane: 9, north: {NORTH}, east: {EAST}, height: {LEVEL}}}\n"
        "  area: [0, 0, 20, 10]\n  cell: 0.5\n  plan: {bank: 10, loads: 4}\n"
    )
    monkeypatch.setenv("TMS_MONGODB_URI", server.uri)
    monkeypatch.setenv("TMS_SITE", str(site))
    monkeypatch.setenv("LC_ALL", "C.UTF-8")
    monkeypatch.chdir(tmp_path)
    return lambda verb, *words: CliRunner().invoke(verb, [str(word) for word in words])


def refusal(call: Callable[[], Any]) -> DbError:
    with pytest.raises(DbError) as caught:
        call()
    return caught.value


def test_a_ground_comes_back_and_the_old_ones_stay(shared_db: store.Db) -> None:
    grounds = GroundSnapshots(shared_db)
    z = np.random.default_rng(1).normal(100.0, 2.0, (30, 20))
    z[3, 4] = np.nan
    first, second = grounds.add(Heights(-1.5, 2.0, 0.2, z), "a.laz"), grounds.add(FLAT, "b.asc")
    back = grounds.read(grounds.find("first"))
    assert (back.x0, back.y0, back.cell) == (-1.5, 2.0, 0.2)
    assert np.allclose(back.z, z, atol=4e-6, equal_nan=True)
    assert [one.source for one in grounds.all()] == ["b.asc", "a.laz"]
    assert grounds.find("last").taken_at == second.taken_at > first.taken_at
    local = first.taken_at.astimezone().isoformat()
    assert grounds.find(local).source == "a.laz" and grounds.find(local[:10]).source == "b.asc"
    assert grounds.find(local.replace("T", " ")).source == "a.laz"
    assert refusal(lambda: grounds.find("1999")).reason == GroundNotThere("1999")


def test_a_damaged_ground_is_told(shared_db: store.Db) -> None:
    grounds = GroundSnapshots(shared_db)
    stored = grounds.add(FLAT, "a.asc")
    shared_db["fs.chunks"].update_one({}, {"$set": {"data": b"PK no zip" * 30}})
    shared_db["fs.files"].update_one({}, {"$set": {"length": 270}})
    assert isinstance(refusal(lambda: grounds.read(grounds.find("last"))).reason, GroundUnreadable)
    shared_db["fs.chunks"].delete_many({})
    assert refusal(lambda: grounds.read(stored)).code == "TERRAIN_MISSING"


def test_a_cycle_that_is_written_twice_counts_once(db: store.Db) -> None:
    cycles = Cycles(db)
    cycles.write([cycle(1, 9), cycle(2, 10), haul(1, 9.5)])
    cycles.write([cycle(2, 10, bank=0.7), cycle(3, 24.5)])
    cycles.write([])
    found = cycles.find()
    assert [(one.machine, one.number, one.bank) for one in found] == [
        ("zx200", 1, 0.5), ("ic120_1", 1, 0.5), ("zx200", 2, 0.7), ("zx200", 3, 0.5),
    ]  # fmt: skip
    assert found[0] == cycle(1, 9)
    assert [one.number for one in cycles.find(machine="zx200", begin=DAY, end=DAY + timedelta(days=1))] == [1, 2]
    assert [one.number for one in cycles.find("run-1", begin=DAY + timedelta(days=1))] == [3]
    assert cycles.find("run-2") == []


def test_cycles_come_in_beside_states_of_machines(db: store.Db) -> None:
    app: Any = SimpleNamespace(site=SimpleNamespace(models={}))
    services, answer = TaskServices(app, db), WriteMachineStates.Response()
    pose = MachineState(collection="machine_pose", machine="zx200", msg="{}")
    work = MachineState(collection="cycle", machine="zx200", msg=cycle(1, 9).model_dump_json())
    for _ in range(2):
        services.write_machine_states(WriteMachineStates.Request(states=[work, pose]), answer)
    assert Cycles(db).find() == [cycle(1, 9)] and db["machine_pose"].count_documents({}) == 2
    for text, code in (("{}", "BAD_CYCLE"), ("[]", "BAD_RECORD"), ("{", "BAD_RECORD")):
        wrong = MachineState(collection="cycle", machine="zx200", msg=text)
        request = WriteMachineStates.Request(states=[pose, work, wrong])
        assert refusal(partial(services.write_machine_states, request, answer)).code == code
    assert db["machine_pose"].count_documents({}) == 2, "of a batch that is refused nothing is stored"


def test_cycles_that_are_refused(db: store.Db) -> None:
    back = {**cycle(1, 9).model_dump(), "ended_at": DAY}
    why = refusal(lambda: checked(back))
    assert isinstance(why.reason, BadCycle) and why.reason.find(EndsBeforeBegin) is not None
    Cycles(db).write([cycle(1, 9)])
    db["cycle"].update_one({}, {"$set": {"mass": "much"}})
    why = refusal(Cycles(db).find)
    assert isinstance(why.reason, CycleUnreadable) and why.reason.cycle == "run-1/zx200/1" and why.code == "BAD_RECORD"


def test_import_show_and_export(tms: Callable[..., Result], tmp_path: Path, shared_db: store.Db) -> None:
    made = tms(ground.command, "import", files.geotiff(tmp_path / "a.tif"), "--json")
    assert json.loads(made.stdout)["columns"] == 40, made.exception
    shown = json.loads(tms(ground.command, "show", "--json").stdout)
    assert (shown["known_m2"], shown["source"]) == (200.0, "a.tif")
    assert shown["least_m"] == pytest.approx(files.height(0.25, 9.75), abs=1e-4)
    assert tms(ground.command, "export", "last", tmp_path / "out.asc").exit_code == 0
    again = tms(ground.command, "import", tmp_path / "out.asc", "--map")
    assert again.exit_code == 0 and "20.0 x 10.0 m, 0.5 m" in again.stdout
    assert [line.split()[-1] for line in tms(ground.command, "list").stdout.splitlines()] == ["out.asc", "a.tif"]
    same = json.loads(tms(ground.command, "volume", "--json").stdout)
    assert same["cut_m3"] < 0.1 and same["fill_m3"] < 0.1 and same["area_m2"] == 200.0
    assert "File exists" in str(tms(ground.command, "export", "last", tmp_path / "out.asc").exception)
    assert tms(ground.command, "export", "last", tmp_path / "out.txt").exit_code == 2
    assert shared_db["fs.files"].count_documents({}) == 2
    assert "out.asc" in tms(ground.command, "rm", "last").stdout
    assert json.loads(tms(ground.command, "rm", "last", "--json").stdout)["removed"]["source"] == "a.tif"
    assert getattr(tms(ground.command, "rm", "last").exception, "code", "") == "GROUND_NOT_THERE"
    assert shared_db["fs.chunks"].count_documents({}) == 0


def test_a_geotiff_is_exported_with_its_coordinates(
    tms: Callable[..., Result], tmp_path: Path, shared_db: store.Db
) -> None:
    x, y = np.meshgrid(np.arange(40) * 0.5 + 0.25, np.arange(20) * 0.5 + 0.25)
    z = files.height(x, y)
    z[3, 4] = np.nan
    GroundSnapshots(shared_db).add(Heights(0.0, 0.0, 0.5, z), "a")
    assert tms(ground.command, "export", "last", "out.tif").exit_code == 0
    assert "have no height" in str(tms(ground.command, "import", "out.tif").exception)
    assert tms(ground.command, "import", "out.tif", "--keep-holes", "--json").exit_code == 0
    back = GroundSnapshots(shared_db).read(GroundSnapshots(shared_db).find("last"))
    assert np.allclose(back.z, z, atol=1e-5, equal_nan=True)
    (tmp_path / "site.yaml").write_text((tmp_path / "site.yaml").read_text().replace("height:", "yaw: 0.1, height:"))
    refused = tms(ground.command, "export", "last", "turned.tif").exception
    assert getattr(refused, "code", "") == "NOT_ALONG_PLANE" and not (tmp_path / "turned.tif").exists()


def test_a_ground_of_which_nothing_is_known(tms: Callable[..., Result], shared_db: store.Db) -> None:
    GroundSnapshots(shared_db).add(Heights(0.0, 0.0, 1.0, np.full((2, 3), np.nan)), "a")
    assert "known: 0.0 of 6.0 m²" in tms(ground.command, "show").stdout
    assert json.loads(tms(ground.command, "volume", "--plane", "0", "--json").stdout)["fill_at_most_m3"] is None


def test_a_refused_file_leaves_nothing(tms: Callable[..., Result], tmp_path: Path, shared_db: store.Db) -> None:
    for path, words in (
        (files.geotiff(tmp_path / "a.tif", hole=-9999), ()),
        (files.cloud(tmp_path / "a.laz", height_scale=1000), ()),
        (files.ascii_grid(tmp_path / "a.asc"), ()),
        (files.ascii_grid(tmp_path / "b.asc", xllcorner=0), ("--epsg", 6677)),
        (tmp_path / "none.png", ("--width", 1, "--height", 1, "--elevation", 1)),
    ):
        error = tms(ground.command, "import", path, *words).exception
        assert getattr(error, "code", "") == "BAD_GROUND", path
    assert shared_db["fs.files"].count_documents({}) == shared_db["fs.chunks"].count_documents({}) == 0


def test_options_of_an_import_that_are_refused(tms: Callable[..., Result], tmp_path: Path) -> None:
    asc = files.ascii_grid(tmp_path / "a.asc")
    for words in (("--cell", "nan"), ("--cell", 0), ("--area", 0, 0, "inf", 5), ("--width", 0), ("--offset-x", "nan")):
        assert tms(ground.command, "import", asc, "--epsg", 6677, *words).exit_code == 2, words
    inside_out = tms(ground.command, "import", asc, "--epsg", 6677, "--area", 10, 0, 0, 5).exception
    assert "--area: must be [least x" in str(inside_out)


def test_volumes_of_grounds_and_designs(tms: Callable[..., Result], shared_db: store.Db, tmp_path: Path) -> None:
    grounds = GroundSnapshots(shared_db)
    grounds.add(FLAT, "before")
    grounds.add(dug(0.5), "after")

    def volume(*words: object) -> dict[str, float]:
        done = tms(ground.command, "volume", *words, "--json")
        assert done.exit_code == 0, (done.output, done.exception)
        found: dict[str, float] = json.loads(done.stdout)
        return found

    assert volume()["cut_m3"] == volume("first", "last")["cut_m3"] == volume("first")["cut_m3"] == pytest.approx(5.0)
    assert volume("last", "first")["fill_m3"] == pytest.approx(5.0)
    assert volume("--plane", "0")["fill_m3"] == pytest.approx(5.0)
    assert volume("first", "--plane", "-0.1,0,0")["cut_m3"] == pytest.approx(20.0)
    assert volume("--inside", "0,0 4,0 4,12 0,12")["cut_m3"] == pytest.approx(0.5)  # one column of four cells
    pit = volume("first", "--pit", "4,4 9,4 9,9 4,9", "--floor", "-1", "--rim", "0", "--slope", "1:0.01")
    assert pit["cut_m3"] == pytest.approx(25.0, rel=0.02)
    design = volume("first", "--design", files.landxml(tmp_path / "d.xml"))
    x, y = FLAT.centres
    there = (x > -1.5) & (y < 12)
    assert design["fill_m3"] == pytest.approx(float(np.maximum(files.height(x, y), 0)[there].sum()) / 4, rel=0.05)
    for words in (("a", "b", "c"), ("a", "b", "--plane", "0"), ("--pit", "0,0 1,0 1,1"), ("--pit", "0,0 1,0"),
                  ("--plane", "high"), ("--slope", "steep"), ("--plane", "0", "--design", "d.xml")):  # fmt: skip
        assert tms(ground.command, "volume", *words).exit_code == 2, words
    text = tms(ground.command, "volume").stdout
    assert "cut 5.00 m³, fill 0.00 m³, net -5.00 m³" in text


def test_diff_tells_where_and_draws_it(tms: Callable[..., Result], shared_db: store.Db, tmp_path: Path) -> None:
    grounds = GroundSnapshots(shared_db)
    grounds.add(FLAT, "before")
    changed = dug(0.5)
    changed.z[4, 12], changed.z[0, 0] = -0.8, np.nan
    grounds.add(changed, "after")
    shown = json.loads(tms(ground.command, "diff", "first", "last", "--picture", "c.png", "--json").stdout)
    assert (shown["deepest_m"], shown["deepest_x"], shown["deepest_y"]) == (pytest.approx(-0.8), 4.75, 4.25)
    assert shown["unknown_m2"] == 0.25 and shown["cut_at_most_m3"] > shown["cut_m3"]
    assert "lowered most: -0.80 m at (4.8, 4.2)" in tms(ground.command, "diff", "first").stdout
    with Image.open(tmp_path / "c.png") as picture:
        pixels = np.asarray(picture)
    # What has changed is from x 3.5 to 8.5 and y 4 to 6: x from 0.5 to 11.5 and y from 2 to 10 are shown.
    side = (pixels.shape[1] - LEFT - RIGHT) // 22  # pixels a cell
    assert side > 20 and pixels.shape == (TOP + 16 * side + BOTTOM, LEFT + 22 * side + RIGHT, 3)

    def at(x: float, y: float) -> list[int]:
        found: list[int] = pixels[TOP + round((10 - y) / 0.5 * side), LEFT + round((x - 0.5) / 0.5 * side)].tolist()
        return found

    assert at(4.75, 4.25) == [178, 24, 43] and at(3.3, 5.3) == [247] * 3
    assert at(8.2, 5.3) == pytest.approx([183, 40, 58], abs=2), "half a metre; 98 % have changed by no more than 0.54 m"
    assert (pixels[-BOTTOM + 10 :, LEFT:] < 100).any() and (pixels[:, : LEFT - 12] < 100).any(), "coordinates"
    assert pixels[TOP + 5, 1 - RIGHT + 35].tolist() == pytest.approx([33, 102, 172], abs=10), "the scale"
    assert tms(ground.command, "diff", "first", "last", "--picture", "c.png").exception is not None


def test_work_by_machine_hour_and_day(tms: Callable[..., Result], shared_db: store.Db) -> None:
    assert "no work" in tms(work.command).stderr
    Cycles(shared_db).write([cycle(1, 9), cycle(2, 9.5), cycle(3, 10.2), haul(1, 10), cycle(4, 25)])
    found = json.loads(tms(work.command, "--day", "2025-11-26", "--json").stdout)
    assert list(found["groups"]) == ["ic120_1", "zx200"]
    assert found["total"]["bank_m3"] == pytest.approx(1.5) and found["total"]["truck_loads"] == 1
    assert found["total"]["bank_m3_per_hour"] == pytest.approx(45.0)
    hours = json.loads(tms(work.command, "--by", "hour", "--machine", "zx200", "--json").stdout)["groups"]
    assert [(name[-2:], one["cycles"]) for name, one in hours.items()] == [("09", 2), ("10", 1), ("01", 1)]
    text = tms(work.command, "--by", "day", "--csv").stdout
    assert tms(work.command, "--run", "none", "--by", "day", "--csv").stdout == text.splitlines(keepends=True)[0]
    rows = list(csv.DictReader(io.StringIO(text)))
    assert [row["day"] for row in rows] == ["2025-11-26", "2025-11-27"] and float(rows[0]["dig_dig_s"]) == 45.0
    table = tms(work.command, "--run", "run-1").stdout.splitlines()
    assert [line.split()[:3] for line in table[1:]] == [
        ["ic120_1", "0", "0.00"],
        ["zx200", "4", "2.00"],
        ["all", "4", "2.00"],
    ]
    assert tms(work.command, "--day", "soon").exit_code == tms(work.command, "--json", "--csv").exit_code == 2
    assert json.loads(tms(work.command, "--day", "yesterday", "--json").stdout)["groups"] == {}
    assert "seen" not in "".join(table)
    missed = cycle(5, 26)
    away = {"begun_at": missed.begun_at - timedelta(seconds=90), "unseen": 90.0}
    Cycles(shared_db).write([missed.model_copy(update=away)])
    assert "1.5 min of machine time were not seen" in tms(work.command).stdout.splitlines()[-1]
    total = json.loads(tms(work.command, "--json").stdout)["total"]
    assert total["unseen_s"] == 90.0 and total["bank_m3_per_hour"] == pytest.approx(45.0), "of the time that was seen"


def test_the_daily_report(tms: Callable[..., Result], shared_db: store.Db, tmp_path: Path) -> None:
    Cycles(shared_db).write([cycle(1, 9), cycle(2, 9.5), cycle(3, 12.2), haul(1, 10)])
    done = tms(report.command, "--day", "2025-11-26")
    assert done.exit_code == 0, done.exception
    assert done.stdout == "daily-report-2025-11-26.html: 3 cycles, 1.5 m³ bank, 1 truck loads\n"
    text = (tmp_path / "daily-report-2025-11-26.html").read_text(encoding="utf-8")
    assert "<th>Soil dug, bank [m³]</th><td>10.0</td><td>1.5</td><td>15 %</td>" in text
    assert text.count("<svg") == 2 and "<img" not in text
    assert "File exists" in str(tms(report.command, "--day", "2025-11-26").exception)
    assert tms(report.command, "--day", "2025-11-26", "--output", "r.txt").exit_code == 2
    again = tms(report.command, "--day", "2025-11-26", "--overwrite", "--language", "ja", "--json")
    assert json.loads(again.stdout)["total"]["cycles"] == 3
    text = (tmp_path / "daily-report-2025-11-26.html").read_text(encoding="utf-8")
    assert (
        "作業日報 yard 2025-11-26" in text
        and "ダンプ待ち" in text
        and not re.search(r"[a-z]{3,} [a-z]{3,}", prose(text))
    )


def prose(page: str) -> str:
    """What people read of a page."""
    return re.sub(r"<style>.*?</style>|<[^>]*>", "\n", page, flags=re.DOTALL)


@pytest.fixture
def fonts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """The folder of the fonts of this PC, which is empty."""
    folder = tmp_path / "fonts"
    folder.mkdir()
    monkeypatch.setattr(letters, "FOLDER", folder)
    letters.font.cache_clear()
    yield folder
    letters.font.cache_clear()


def test_a_report_of_today_has_the_change_of_the_ground(
    tms: Callable[..., Result], shared_db: store.Db, tmp_path: Path, fonts: Path
) -> None:
    assert tms(report.command, "--day", "today", "--output", "none.html").exit_code == 0
    assert "No work is recorded" in (tmp_path / "none.html").read_text(encoding="utf-8")
    grounds = GroundSnapshots(shared_db)
    grounds.add(FLAT, "before")
    grounds.add(dug(0.4), "after")
    today = utc_now()
    Cycles(shared_db).write([cycle(1, 0, begun_at=today - timedelta(seconds=40), ended_at=today)])
    for name in ("r.html", "r.pdf", "embedded.pdf"):
        if name == "embedded.pdf":
            shutil.copy(Path(reportlab.__file__).parent / "fonts" / "Vera.ttf", fonts / "ipaexg.ttf")
            letters.font.cache_clear()
        done = tms(report.command, "--day", "today", "--language", "ja", "--output", name)
        assert done.exit_code == 0, done.exception
    text = (tmp_path / "r.html").read_text(encoding="utf-8")
    assert "<th>切土</th><td>4.0</td><td>4.0</td>" in text and "data:image/png;base64," in text
    data = (tmp_path / "r.pdf").read_bytes()
    assert data.startswith(b"%PDF") and b"/HeiseiKakuGo-W5" in data and b"/Subtype /Image" in data
    data = (tmp_path / "embedded.pdf").read_bytes()
    assert b"/FontFile2" in data and b"/HeiseiKakuGo-W5" not in data


def test_cycles_are_told_over_ros(shared_db: store.Db) -> None:
    """Those of a span, as JSON that their model takes again."""
    noon = datetime(2026, 11, 26, 12, tzinfo=timezone.utc)
    made = [
        Cycle(run_id="r", machine="zx200", number=number + 1, kind="dig", begun_at=at, ended_at=at, parts={}, bank=0.5)
        for number in range(3)
        for at in (noon + timedelta(hours=number),)
    ]
    Cycles(shared_db).write(made)
    answer = ListCycles.Response()
    span = {"begin": made[1].ended_at.isoformat(), "end": made[2].ended_at.isoformat()}
    WorkServices(shared_db).read(ListCycles.Request(**span), answer)
    assert [Cycle.model_validate_json(one) for one in answer.cycles] == [made[1]]
    with pytest.raises(DbError) as caught:
        WorkServices(shared_db).read(ListCycles.Request(begin="today", end=span["end"]), answer)
    assert caught.value.code == "NO_ZONE"
