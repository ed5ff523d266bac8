"""Watches a stopped machine: if it moves without a goal, it is stopped again."""

LASTS = 0.2  # s for which a motion must be seen: one shake of the ground is none
SETTLED = 5.0  # s after a re-arm for which it is still watched: some machines jump when their stop is released


class Vigil:
    """The pulse asks it; times are monotonic seconds."""

    def __init__(self) -> None:
        self._watching = False
        self._until: float | None = None
        self._since: float | None = None
        self._from = float("-inf")

    def begin(self) -> None:
        """Begin to watch: the machine was stopped, or is held or latched."""
        self._watching, self._until, self._from = True, None, float("-inf")

    def end(self, now: float | None = None, jumps: float = 0.0) -> None:
        """End the watch, as a goal may move it; after a re-arm at `now`, from `jumps` to SETTLED after it (facts)."""
        self._watching, self._since = now is not None and self._watching, None
        self._until = None if now is None else now + SETTLED
        self._from = float("-inf") if now is None else now + jumps

    def left(self, now: float, moved_at: float) -> bool:
        """Whether it has left stand-still; `moved_at` is when a motion was last seen."""
        if self._until is not None and now > self._until:
            self.end()
        if not self._watching or now < self._from or now - moved_at > LASTS:
            self._since = None
            return False
        self._since = now if self._since is None else self._since
        return now - self._since >= LASTS
