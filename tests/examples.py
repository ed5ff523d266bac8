"""How many examples a test of generated cases takes, where those of hypothesis' profile are not what it needs."""

from hypothesis import settings

FAST, USUAL, THOROUGH = 10, 50, 400  # examples a test in `make test-fast`, `make test` and `make nightly`


def register() -> None:
    """The profiles of `--hypothesis-profile`. No deadline: a busy machine would flip the test."""
    for name, count in (("fast", FAST), ("usual", USUAL), ("thorough", THOROUGH)):
        settings.register_profile(name, max_examples=count, deadline=None)
    settings.load_profile("usual")


def examples(usual: int, thorough: int) -> int:
    """So many in `make test` and in `make nightly`."""
    return thorough if settings.default is not None and settings.default.max_examples > USUAL else usual
