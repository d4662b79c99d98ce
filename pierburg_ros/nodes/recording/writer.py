"""Messages to the file that is open, and what happens when the disk does not take them."""

from __future__ import annotations

import time
from collections.abc import Iterable

from pierburg_ros.errors import InputError
from pierburg_ros.nodes.recording.file import RecordingFile
from pierburg_ros.nodes.recording.series import RecordingSeries
from pierburg_ros.nodes.recording.topics import Received

RETRIED = 1.0
"""Time [s] after which a new file is tried where the last one ended for want of room."""


class RecordingWriter:
    """Writes one file after another; one that the disk ends is marked as cut, and a new one is tried."""

    def __init__(self, series: RecordingSeries) -> None:
        self.file: RecordingFile | None = None
        self.problem = ""
        self.unwritten = 0
        self._series = series
        self._flushed = self._tried = time.monotonic()

    def begin(self) -> None:
        """Go on in a new file, and complete the one before; InputError where there can be none."""
        self._tried = time.monotonic()
        before, self.file = self.file, self._series.open()
        self.problem = ""
        if before is not None:
            self._finish(before)

    def end(self) -> None:
        """Complete the file; `problem` says so where the disk does not take its end."""
        finished, self.file = self.file, None
        self._finish(finished)

    def rest(self) -> None:
        """Stop trying: no file is wanted."""
        self.problem = ""

    def is_due_again(self) -> bool:
        """Whether a file is wanted and it is time to try one."""
        return bool(self.problem) and self.file is None and time.monotonic() - self._tried > RETRIED

    def write(self, messages: Iterable[tuple[Received, int, int]], flush_interval: float) -> bool:
        """Append messages with publish and log times [ns]; False where the disk has ended the file meanwhile.

        What comes while a file is wanted and none is there is counted as unwritten.
        """
        if self.file is None:
            self.unwritten += sum(1 for _ in messages) if self.problem else 0
            return True
        try:
            for each, published, logged in messages:
                self.file.add(each.topic, each.data, each.missing, published, logged)
            if time.monotonic() - self._flushed > flush_interval:
                self.file.flush()
                self._flushed = time.monotonic()
        except OSError as error:
            finished, self.file = self.file, None
            self._give_up(finished, error)
            return False
        return True

    def _finish(self, file: RecordingFile) -> None:
        try:
            self._series.finish(file)
        except OSError as error:
            self._give_up(file, error)
        except InputError as error:
            self.problem = str(error)

    def _give_up(self, file: RecordingFile, error: OSError) -> None:
        self._tried = time.monotonic()
        path = self._series.give_up(file)
        self.problem = f"{path} is cut: {error.strerror}. Make room; 'pierburg recover' makes it whole."
