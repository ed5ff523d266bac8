"""Recordings in a store: what was told comes back by run and by time, thinned, and goes when it is old."""

from datetime import datetime, timedelta, timezone

import numpy as np
import pytest
from tms_msg_db.srv import ReadRecording

from tms_config.site_file import Store
from tms_db import recordings, store
from tms_db.history import History, Run
from tms_db.reasons import RecordingDamaged, RunMissing
from tms_db.recording_piece import JOINTS, LOAD, POSE, Piece
from tms_db.recording_services import RecordingServices
from tms_db.recordings import COLLECTION, Recordings
from tms_db.retention import delete_recordings
from tms_db.values import to_time
from tms_reason.errors import DbError

NOON = datetime(2026, 1, 31, 12, tzinfo=timezone.utc)


def record(db: store.Db, machine: str, count: int, begin: datetime = NOON) -> None:
    """Pieces of 10 s one after the other: an angle that tells the seconds since `begin`, and a place now and then."""
    pieces = []
    for number in range(count):
        piece = Piece(machine, begin + timedelta(seconds=10 * number), 0.0)
        for tick in range(100):
            piece.add(JOINTS, ("boom_joint",), tick / 10, (10 * number + tick / 10,))
        piece.add(POSE, ("x", "y", "yaw"), 5.0, (1.0 * number, 2.0, 3.0))
        document = piece.document()
        assert document is not None
        pieces.append(document)
    Recordings(db).write(pieces)
    Recordings(db).write(pieces)  # sent again: its answer was lost


def test_it_comes_back_by_time_and_thinned(db: store.Db) -> None:
    record(db, "zx200", 6)
    read = Recordings(db).read
    (joints, pose) = read("zx200", NOON + timedelta(seconds=12), NOON + timedelta(seconds=31.5), 10_000)
    assert (joints.kind, joints.names, pose.kind, pose.names) == (JOINTS, ("boom_joint",), POSE, ("x", "y", "yaw"))
    assert joints.rows[:, 0] - NOON.timestamp() == pytest.approx(joints.rows[:, 1])
    assert joints.rows[[0, -1], 1] == pytest.approx([12.0, 31.5])
    assert len(joints.rows) == 196 and pose.rows[:, 1].tolist() == [1.0, 2.0]
    thin = read("zx200", NOON, NOON + timedelta(hours=1), 11)[0].rows[:, 1]
    assert len(thin) == 11 and thin[[0, -1]] == pytest.approx([0.0, 59.9])
    assert read("ic120", NOON, NOON + timedelta(hours=1), 11) == []
    assert read("zx200", NOON + timedelta(hours=1), NOON + timedelta(hours=2), 11) == []


def test_of_a_long_one_some_pieces_are_read(db: store.Db, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(recordings, "PIECES", 4)
    record(db, "zx200", 12)
    (joints, _) = Recordings(db).read("zx200", NOON, NOON + timedelta(hours=1), 10_000)
    assert len(joints.rows) == 400, "every third piece"
    assert joints.rows[-1, 1] == pytest.approx(99.9)


def test_a_run_tells_its_time_and_a_tail(db: store.Db) -> None:
    record(db, "zx200", 6)
    record(db, "ic120", 1, NOON + timedelta(seconds=20))
    run = Run("r-1", 4, "", "success", "", ("zx200",), NOON + timedelta(seconds=10), NOON + timedelta(seconds=15))
    History(db).write([run], [])
    services = RecordingServices(db)

    def ask(**asked: object) -> list[tuple[str, str, float, float, int]]:
        answer = ReadRecording.Response()
        services.read(ReadRecording.Request(**asked), answer)
        since = NOON.timestamp()
        return [
            (one.machine, one.kind, round(one.times[0] - since, 3), round(one.times[-1] - since, 3), len(one.values))
            for one in answer.series
        ]

    (truck, place, arm, _) = ask(run_id="r-1")
    assert (truck, place) == (("ic120", JOINTS, 20.0, 25.0, 51), ("ic120", POSE, 25.0, 25.0, 3))
    assert arm == ("zx200", JOINTS, 10.0, 25.0, 151)
    begin = to_time(NOON + timedelta(seconds=40))
    assert ask(begin=begin, machine="zx200")[0] == ("zx200", JOINTS, 40.0, 59.9, 200)
    assert ask(begin=begin, end=to_time(NOON + timedelta(seconds=41)), machine="zx200")[0][4] == 11
    assert ask(begin=begin, machine="ic120") == []
    with pytest.raises(DbError) as missing:
        ask(run_id="r-2")
    assert missing.value.reason == RunMissing("r-2")


def test_a_damaged_piece_is_named(db: store.Db) -> None:
    record(db, "zx200", 1)
    db[COLLECTION].update_one({}, {"$set": {f"series.{JOINTS}.data": b"nothing"}})
    with pytest.raises(DbError) as damaged:
        Recordings(db).read("zx200", NOON, NOON + timedelta(hours=1), 11)
    assert isinstance(damaged.value.reason, RecordingDamaged) and damaged.value.code == "BAD_RECORD"


def test_old_ones_go(db: store.Db) -> None:
    assert Store().recording_days == 30
    assert delete_recordings(db, 7, NOON) == 0
    record(db, "zx200", 2, NOON - timedelta(days=8))
    record(db, "zx200", 2)
    assert delete_recordings(db, 7, NOON + timedelta(days=3650)) == 2, "a clock that is ahead deletes no more"
    assert [one["begin"] for one in db[COLLECTION].find().sort("begin", 1)] == [NOON, NOON + timedelta(seconds=10)]
    assert delete_recordings(db, 7, NOON) == 0
    assert np.isfinite(Recordings(db).read("zx200", NOON, NOON + timedelta(hours=1), 50)[0].rows).all()


def test_loads_have_their_names(db: store.Db) -> None:
    piece = Piece("ic120", NOON, 0.0)
    piece.add(LOAD, ("mass", "bank", "loose"), 1.0, (1600.0, 0.8, 1.0))
    document = piece.document()
    assert document is not None
    Recordings(db).write([document])
    (load,) = Recordings(db).read("ic120", NOON, NOON + timedelta(hours=1), 50)
    assert load.rows[0, 1:].tolist() == pytest.approx([1600.0, 0.8, 1.0])
