"""What waits to be sent: commands, and up to ten messages of each topic. Pure."""

from collections import deque

from operasim.framing import frame

QUEUE = 10  # messages of a topic


class Outbox:
    """Keeps the order of sending. Of a full topic the oldest message is dropped, and one turn of the topic is void."""

    def __init__(self) -> None:
        self._turns: deque[str | bytes] = deque()  # a topic whose turn it is, or a command
        self._waiting: dict[str, deque[bytes]] = {}
        self._void: dict[str, int] = {}
        self.dropped = 0

    def command(self, data: bytes) -> None:
        """Add a command."""
        self._turns.append(data)

    def message(self, topic: str, payload: bytes) -> None:
        """Add a message of a topic."""
        waiting = self._waiting.setdefault(topic, deque())
        if len(waiting) >= QUEUE:
            waiting.popleft()
            self.dropped += 1
            self._void[topic] = self._void.get(topic, 0) + 1
        waiting.append(payload)
        self._turns.append(topic)

    def take(self) -> bytes | None:
        """The next frame; None when nothing waits."""
        while self._turns:
            turn = self._turns.popleft()
            if isinstance(turn, bytes):
                return turn
            if self._void.get(turn, 0):
                self._void[turn] -= 1
            else:
                return frame(turn, self._waiting[turn].popleft())
        return None

    def clear(self) -> None:
        """Forget all."""
        self._turns.clear()
        self._waiting.clear()
        self._void.clear()
