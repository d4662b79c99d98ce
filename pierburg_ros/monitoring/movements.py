"""Cuts a stream of samples into windows that begin at rest, hold a movement, and end before the next one."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Signal = NDArray[np.float64]

BLOCK_SAMPLES = 25
"""Samples looked at together: their mean has a fifth of the sensor's noise, and at 500 Hz they last 50 ms."""
LONGEST_MOVEMENT = 40
"""Blocks of the longest window: 2 s at 500 Hz, in which a movement of the valve ends and its creep to rest shows."""
QUIET = 4
"""Blocks without motion after which another movement begins a window of its own."""
MOTION = 8.0
"""Change of a block's mean from the one before, in standard deviations of that change, that counts as motion.

Beyond 6 a day of 1.7 million blocks of Gaussian noise holds less than 0.01 false ones; the rest is for noise that is
not Gaussian. A false one costs a window without information, no more.
"""
LEAD = 15
"""Samples at the start of a window in which the shaft rests for certain: motion begins after the first block."""
SETTLED_BLOCKS = 2
"""Quiet blocks that still belong to a movement: the shaft comes to rest in them, and noise alone would follow."""
REMEMBERED = 400
"""Quiet blocks that the sensor's noise is estimated from: 20 s at 500 Hz."""

UNUSUAL = 4.0
"""Mean square of a block beyond this many medians is no noise: Gaussian noise is there once in a million blocks."""


@dataclass(frozen=True)
class Samples:
    """A stream in part, all of shape (samples,): `angle` as decoded, `duty` in force from a sample to the next.

    `whole` is False where the sample before is missing or the duty is not known; `supply_voltage` is NaN where none
    is measured.
    """

    time: Signal  # [s]
    angle: Signal  # [rad]
    duty: Signal  # [1]
    supply_voltage: Signal  # [V]
    whole: NDArray[np.bool_]

    @staticmethod
    def joined(parts: list[Samples]) -> Samples:
        """Parts that follow each other as one."""
        names = ("time", "angle", "duty", "supply_voltage", "whole")
        return Samples(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))

    def cut(self, first: int, last: int) -> Samples:
        """The samples from `first` up to `last`."""
        part = slice(first, last)
        return Samples(self.time[part], self.angle[part], self.duty[part], self.supply_voltage[part], self.whole[part])


@dataclass(frozen=True)
class Movement:
    """One window; `noise` [rad] is the standard deviation of the sensor's noise.

    `samples` end soon after the motion, `aftermath` goes on from them until the next motion, or for 2 s at 500 Hz.
    """

    samples: Samples
    aftermath: Samples
    noise: float

    @property
    def start(self) -> float:
        """Angle at rest before the motion [rad]."""
        return float(np.mean(self.samples.angle[:LEAD]))


class Blocks:
    """Cuts a stream into blocks; what does not fill one waits for the next samples."""

    def __init__(self) -> None:
        self._rest: list[Samples] = []

    def take(self, samples: Samples) -> list[Samples]:
        """Blocks that these samples fill."""
        waiting = Samples.joined([*self._rest, samples])
        end = waiting.time.size - waiting.time.size % BLOCK_SAMPLES
        self._rest = [waiting.cut(end, waiting.time.size)]
        return [waiting.cut(first, first + BLOCK_SAMPLES) for first in range(0, end, BLOCK_SAMPLES)]


class Movements:
    """Takes blocks as they come and gives each window when it is complete."""

    def __init__(self) -> None:
        self._before: Samples | None = None
        self._window: list[Samples] = []
        self._quiet = 0
        self._last = 0
        self._squares: deque[float] = deque(maxlen=REMEMBERED)
        self._steps: deque[float] = deque(maxlen=REMEMBERED)
        self.noise = 0.0

    def take(self, block: Samples) -> Movement | None:
        """The window that ended before this block, if one did."""
        if not np.all(block.whole):
            self._window, self._before = [], None
            return None
        moves = self._moves(block)
        self._before, before = block, self._before
        if not moves:
            self._listen(block)
        if self._window:
            return self._grown(block, before, moves)
        if moves and before is not None:
            self._window, self._quiet, self._last = [before, block], 0, 2
        return None

    def _grown(self, block: Samples, before: Samples | None, moves: bool) -> Movement | None:
        again = moves and self._quiet >= QUIET
        if not again and len(self._window) < LONGEST_MOVEMENT:
            self._window.append(block)
            self._quiet = 0 if moves else self._quiet + 1
            self._last = len(self._window) if moves else self._last
            return None
        ended = self._ended()
        self._window, self._quiet, self._last = [], 0, 2
        if moves and before is not None:
            self._window = [before, block]
        return ended

    def _ended(self) -> Movement:
        window = Samples.joined(self._window)
        end = min(self._last + SETTLED_BLOCKS, len(self._window)) * BLOCK_SAMPLES
        return Movement(window.cut(0, end), window.cut(end, window.time.size), self.noise)

    def _moves(self, block: Samples) -> bool:
        if self._before is None or self.noise == 0.0:
            self._listen(block)
            return False
        change = abs(float(np.mean(block.angle)) - float(np.mean(self._before.angle)))
        return bool(change > MOTION * self.noise * np.sqrt(2.0 / BLOCK_SAMPLES))

    def _listen(self, block: Samples) -> None:
        """Take the noise from second differences, which a slow creep leaves alone; at least that of the converter."""
        self._squares.append(float(np.mean(np.diff(block.angle, 2) ** 2) / 6.0))
        steps = np.abs(np.diff(block.angle))
        self._steps.append(float(np.min(steps[steps > 0.0], initial=np.inf)))
        squares = np.array(self._squares)
        usual = squares[squares <= UNUSUAL * np.median(squares)]
        step = min(self._steps)
        converter = step / np.sqrt(12.0) if np.isfinite(step) else 0.0
        self.noise = max(float(np.sqrt(np.mean(usual))), converter)
