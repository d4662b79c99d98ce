"""A thread that only receives, so that nothing the recorder does meanwhile can make a reader run over."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from threading import Event, Lock, Thread

from pierburg_ros.nodes.recording.topics import Received, RecordedTopics

RECEIVER_LOOK = 0.005
"""Time [s] between two looks: a hundredth of a reader's capacity at 4000 messages a second."""


class Receiver:
    """Takes messages from their subscriptions all the time, and hands them over when asked."""

    def __init__(self, topics: RecordedTopics) -> None:
        self._topics = topics
        self._batches: deque[list[Received]] = deque()
        self._lock = Lock()
        self._stopping = Event()
        self._failure: BaseException | None = None
        self._thread = Thread(target=self._receive, name="receiving", daemon=True)
        self._thread.start()

    def received(self) -> Iterator[Received]:
        """What has come since the last call; a turn's messages come together or not at all."""
        if self._failure is not None:
            raise self._failure
        for _ in range(len(self._batches)):
            yield from self._batches.popleft()

    def turn(self) -> None:
        """Take all that has arrived."""
        with self._lock:
            if found := self._topics.take():
                self._batches.append(found)

    def stop(self) -> None:
        """End the thread; what has arrived since its last turn is left to `turn`."""
        self._stopping.set()
        self._thread.join()

    def _receive(self) -> None:
        try:
            while not self._stopping.wait(RECEIVER_LOOK):
                self.turn()
        except BaseException as error:  # handed over, so that the node ends with it instead of going deaf
            self._failure = error
