"""When the samples of a recording lie in its file, as viewers show them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pierburg_ros.arrays import Signal
from pierburg_ros.recording.formats.messages import LATEST, Integers


@dataclass(frozen=True)
class FileTimes:
    """Log and publish time [ns] of the measured messages by the `time` [s] of the recording; all (samples,).

    A recording counts its time on one clock from its first sample. Viewers order messages by the times of the file:
    what shall lie over a sample there needs the times of its message.
    """

    time: Signal
    log_time: Integers
    publish_time: Integers

    @classmethod
    def of(cls, time: Signal, log_time: Integers, publish_time: Integers) -> FileTimes:
        """As recorded; messages without a publish time take their log time."""
        return cls(time, log_time, publish_time if np.any(publish_time) else log_time)

    @classmethod
    def of_column(cls, time: Signal, first: float) -> FileTimes | None:
        """Those of a table whose first time is `first` [s]; None where no file of messages can have such times."""
        latest = first + float(time[-1])
        if not (first >= 0.0 and latest < LATEST * 1e-9):
            return None
        stamps = round(first * 1e9) + np.round(time * 1e9).astype(np.int64)
        return cls(time, stamps, stamps)

    def since(self, origin: float) -> FileTimes:
        """The same for a recording whose time counts from `origin` [s]."""
        return FileTimes(self.time - origin, self.log_time, self.publish_time)

    def at(self, time: ArrayLike) -> tuple[Integers, Integers]:
        """Log and publish time [ns] of `time` [s]: of the message itself, or between those before and after.

        Before the first and after the last message they run on at one second a second.
        """
        asked: NDArray[np.float64] = np.asarray(time, np.float64)
        beyond = asked - np.clip(asked, self.time[0], self.time[-1])
        log_time, publish_time = (
            np.maximum(
                stamps[0]
                + np.round(np.interp(asked, self.time, (stamps - stamps[0]).astype(np.float64))).astype(np.int64)
                + np.round(beyond * 1e9).astype(np.int64),
                0,
            )
            for stamps in (self.log_time, self.publish_time)
        )
        return log_time, publish_time


def counted(time: Signal) -> FileTimes:
    """Times of a recording that lies in no file: they count from its first sample."""
    stamps = np.round(time * 1e9).astype(np.int64)
    return FileTimes(time, stamps, stamps)
