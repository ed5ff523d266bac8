"""What machines carry, for people: sums of what went in and out, and lines that tell what has changed."""

import pytest

from tms_cli.loads import Carried


def filled(bucket: bool, *volumes: float) -> Carried:
    one = Carried(bucket)
    for loose in volumes:
        one.take(loose, loose / 1.25, 0.8 if bucket else 6.0)
    return one


def test_what_goes_in_and_out_of_a_vessel() -> None:
    truck = filled(False, 2.0, 2.0, 2.5, 3.0, 1.0, 0.0, 0.5)
    assert (truck.in_loose, truck.out_loose) == (1.5, 3.0), "what was in it at the start counts when it goes out"
    assert truck.in_bank == pytest.approx(1.5 / 1.25)


def test_a_bucket_that_was_emptied_is_a_cycle() -> None:
    assert filled(True, 0.0, 0.3, 0.7, 0.7, 0.4, 0.0).emptied == 1
    assert filled(True, 0.0, 0.7, 0.0, 0.05, 0.0, 0.6, 0.0).emptied == 2
    assert filled(True, 0.0, 0.1, 0.0).emptied == 0, "a touch of the ground is no dig"
    assert filled(True, 0.0, 0.7, 0.5).emptied == 0, "it still has soil"


def test_a_line_tells_how_full_it_is() -> None:
    line = filled(True, 0.4).line("zx200")
    assert line.startswith("zx200: bucket ") and line.endswith("0.40 of 0.80 m³")
    assert line.count("█") == line.count("░") == 10
    assert filled(False, 9.0).line("ic120").count("█") == 20
    assert Carried(True).line("zx200").count("█") == 0


def test_only_a_large_change_is_news() -> None:
    assert not Carried(bucket=True).is_news(), "nobody has told it"
    bucket = filled(True, 0.0)
    assert not bucket.is_news()
    bucket.take(0.1, 0.1, 0.8)
    assert not bucket.is_news()
    bucket.take(0.2, 0.2, 0.8)
    assert bucket.is_news() and not bucket.is_news()
    bucket.take(0.0, 0.0, 0.8)
    assert bucket.is_news()
