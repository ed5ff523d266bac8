"""Queue of frames for one client: bounded; the oldest messages of topics are dropped. Pure logic."""

import threading
from collections import deque

FRAMES = 2000
BYTES = 32 * 1024 * 1024


class SendQueue:
    """Frames in the order of sending. Safe to call from several threads; `put` never waits."""

    def __init__(self, frames: int = FRAMES, size: int = BYTES) -> None:
        self._waiting: deque[tuple[bytes, bool]] = deque()
        self._frames, self._most, self._size = frames, size, 0
        self._changed = threading.Condition()
        self._closed = False
        self.dropped = 0  # messages that were left out

    def put(self, frame: bytes, droppable: bool = False) -> bool:
        """Queue a frame; False when there is no room even after all droppable messages are dropped."""
        with self._changed:
            if self._closed:
                return True
            while self._full(len(frame)) and self._drop_oldest():
                self.dropped += 1
            if self._full(len(frame)):
                self.dropped += 1
                return droppable
            self._waiting.append((frame, droppable))
            self._size += len(frame)
            self._changed.notify()
            return True

    def _full(self, more: int) -> bool:
        return bool(self._waiting) and (len(self._waiting) >= self._frames or self._size + more > self._most)

    def _drop_oldest(self) -> bool:
        for i, (frame, droppable) in enumerate(self._waiting):
            if droppable:
                del self._waiting[i]
                self._size -= len(frame)
                return True
        return False

    def take(self) -> bytes | None:
        """Wait for the next frame; None when the queue was closed."""
        with self._changed:
            self._changed.wait_for(lambda: self._waiting or self._closed)
            if self._closed:
                return None
            frame, _ = self._waiting.popleft()
            self._size -= len(frame)
            return frame

    def close(self) -> None:
        """Drop all frames and end `take`."""
        with self._changed:
            self._closed = True
            self._waiting.clear()
            self._changed.notify_all()
