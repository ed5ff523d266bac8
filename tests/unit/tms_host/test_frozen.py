"""When a process that does not answer counts as frozen."""

from tms_host.frozen import Answers


def test_only_a_process_that_has_answered_can_be_frozen() -> None:
    answers = Answers(10.0)
    assert not answers.frozen("zx200:rc", 7, False, 100.0)  # still starting
    assert not answers.frozen("zx200:rc", 7, True, 101.0)
    assert not answers.frozen("zx200:rc", 7, False, 110.0)
    assert answers.frozen("zx200:rc", 7, False, 112.0)


def test_a_new_process_starts_anew() -> None:
    answers = Answers(10.0)
    answers.frozen("zx200:rc", 7, True, 100.0)
    assert not answers.frozen("zx200:rc", 8, False, 200.0)
