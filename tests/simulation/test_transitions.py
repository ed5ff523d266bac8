"""The pictures of the state machines in ARCHITECTURE.md show the transitions that happen."""

from simulation.transitions import PAGE, SEEDS, STATES, drawn, observed, page


def test_the_pictures_show_all_that_happens() -> None:
    missing = observed(SEEDS) - drawn(PAGE.read_text(encoding="utf-8"))
    assert missing == set(), "make pictures draws them anew"


def test_the_pictures_have_the_states_of_the_code() -> None:
    text = PAGE.read_text(encoding="utf-8")
    assert page(text, drawn(text)) == text, "make pictures draws them anew"
    assert {machine for machine, _, _ in drawn(text)} == set(STATES)
