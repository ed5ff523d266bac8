"""When a simulator gets the stop of its machine."""

from tms_if.fresh_start import SETTLES, UNKNOWN, FreshStart

STOP, RELEASE = b"true", b"false"


def made() -> tuple[FreshStart, list[tuple[str, bytes]]]:
    sent: list[tuple[str, bytes]] = []
    return FreshStart(lambda topic, data: sent.append((topic, data)), 100.0), sent


def test_one_that_was_only_disconnected_gets_it_with_its_first_stamp() -> None:
    fresh, sent = made()
    fresh.stop("a/emg_stop", STOP, 100.01)
    assert sent == []
    fresh.told(500.0, 100.04)
    assert sent == [("a/emg_stop", STOP)]
    fresh.stop("a/emg_stop", RELEASE, 101.0)
    assert sent[-1] == ("a/emg_stop", RELEASE)


def test_one_that_has_just_begun_gets_the_last_one_when_its_machines_stand() -> None:
    fresh, sent = made()
    fresh.told(0.02, 100.02)
    fresh.stop("a/emg_stop", STOP, 100.1)
    fresh.stop("a/emg_stop", RELEASE, 100.5)
    fresh.stop("a/emg_stop", STOP, 101.0)
    fresh.stop("b/emg_stop", STOP, 102.0)
    fresh.told(SETTLES - 0.1, 105.9)
    assert sent == [] and fresh.young()
    fresh.told(SETTLES, 106.0)
    assert not fresh.young()
    assert sent == [("a/emg_stop", STOP), ("b/emg_stop", STOP)]
    fresh.told(SETTLES + 1.0, 107.0)
    assert len(sent) == 2


def test_one_that_tells_no_time_gets_it_soon() -> None:
    fresh, sent = made()
    fresh.stop("a/emg_stop", STOP, 100.0)
    fresh.told(0.0, 100.1)
    assert sent == [] and not fresh.young()
    fresh.look(100.0 + 1.01 * UNKNOWN)
    assert sent == [("a/emg_stop", STOP)]
