"""A job of earth: each bucket counts once whatever is lost between, and records say what is wrong with them."""

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tms_reason.errors import SubtaskFailed
from tms_subtasks.records.earthwork import Bucket, Counted, Job, counted, earthwork_of, job_of

AREA = {"area_x": [0.0, 4.0, 4.0], "area_y": [0.0, 0.0, 3.0], "floor": -1.0, "near": 4.8, "far": 8.0, "deepest": 1.8,
        "trucks": ["ic120"], "job": "EARTHWORK"}  # fmt: skip


def job(moved: float = 0.0, buckets: int = 0) -> Job:
    return Job(volume=2.0, moved=moved, counted=buckets, done=False)


def bucket(number: int, bank: float = 0.5, before: float = 0.0) -> Bucket:
    return Bucket(x=3.5, y=0.0, number=number, truck="ic120", bank=bank, before=before)


def test_what_the_truck_has_gained_counts() -> None:
    assert counted(job(), bucket(1), 0.45, left=True) == Counted(0.45, 1, done=False)
    assert counted(job(0.45, 1), bucket(2, before=0.45), 0.95, left=True) == Counted(pytest.approx(0.95), 2, done=False)


def test_no_bucket_counts_twice() -> None:
    first = counted(job(), bucket(1), 0.45, left=True)
    again = counted(job(first.moved, first.buckets), bucket(1), 0.45, left=True)
    assert again == first


def test_no_more_counts_than_was_in_the_bucket() -> None:
    assert counted(job(), bucket(1, bank=0.5), 3.0, left=True).moved == 0.5, "the loads were taken from an older file"
    assert counted(job(), bucket(1, before=3.0), 0.0, left=True).moved == 0.0, "the truck has tipped meanwhile"


def test_a_bucket_of_another_job_does_not_count() -> None:
    assert counted(job(), bucket(7), 0.45, left=True) == Counted(0.0, 0, done=False)
    assert counted(job(), bucket(0), 0.45, left=True) == Counted(0.0, 0, done=False), "none was chosen yet"


def test_it_is_done_when_the_volume_is_moved_or_nothing_is_left() -> None:
    assert counted(job(1.6, 3), bucket(4), 0.45, left=True).done
    assert not counted(job(1.4, 3), bucket(4), 0.45, left=True).done
    assert counted(job(0.1, 3), bucket(3), 0.0, left=False).done


@given(st.lists(st.tuples(st.floats(0.0, 0.9), st.integers(1, 4)), max_size=30))
def test_the_sum_is_that_of_the_buckets_however_often_each_is_looked_at(buckets: list[tuple[float, int]]) -> None:
    record: dict[str, Any] = {"volume": 1000.0, "moved": 0.0, "counted": 0, "done": False}
    truck = 0.0
    for number, (bank, looks) in enumerate(buckets, 1):
        emptied = bucket(number, bank, truck)
        truck += bank
        for _ in range(looks):
            record |= counted(Job.model_validate(record), emptied, truck, left=True).fields()
    assert record["counted"] == len(buckets)
    assert record["moved"] == pytest.approx(sum(bank for bank, _ in buckets))


def test_a_record_that_does_not_fit_is_named() -> None:
    read = {("zx200", "earthwork"): AREA, ("zx200", "wrong"): {**AREA, "area_y": [0.0]},
            ("", "EARTHWORK"): {"volume": 2.0, "moved": 0.0, "counted": 0}}  # fmt: skip
    work = earthwork_of(lambda *name: read[name], "zx200", "earthwork")
    assert work.area == [(0.0, 0.0), (4.0, 0.0), (4.0, 3.0)] and work.bounds == (0.0, 0.0, 4.0, 3.0)
    with pytest.raises(SubtaskFailed, match=r"BAD_RECORD: record zx200/wrong: .*area_y"):
        earthwork_of(lambda *name: read[name], "zx200", "wrong")
    with pytest.raises(SubtaskFailed, match=r"record EARTHWORK: .*done"):
        job_of(lambda *name: read[name], "EARTHWORK")
