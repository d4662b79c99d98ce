"""Faults of the sensor that show block by block: frozen, noisier, jumps, an offset at a stop, no answer to the duty."""

from __future__ import annotations

import math
from collections import deque

import numpy as np

from pierburg_ros.monitoring.evidence import predicted
from pierburg_ros.monitoring.findings import Finding
from pierburg_ros.monitoring.movements import BLOCK_SAMPLES, Samples, Signal
from pierburg_ros.plant import Model

FROZEN = 4
"""Blocks of equal samples that show a frozen sensor, where samples scattered before.

Where nine blocks of ten scatter, four without scatter in a row are a chance of 1e-4 at most; with noise above the
converter's step a hundred equal samples do not happen.
"""
BASELINE = 200
"""Blocks from which the usual noise is learnt: 10 s at 500 Hz, known to 1 %."""
LATEST_BLOCKS = 20
"""Blocks whose noise is held against it: 1 s at 500 Hz; the median of 20 varies by 5 %."""
NOISE_RISE = 2.0
"""Rise of the noise that is reported: twenty standard deviations of the estimate."""
SPIKES = 3
"""Blocks with a jump faster than the shaft within `SPIKE_MEMORY` blocks: one or two may be a disturbance outside."""
SPIKE_MEMORY = 1200
"""60 s at 500 Hz."""
TOP_SPEED = 1.5
"""Speed above the motor's no-load speed at its supply that the shaft cannot have: supplies reach 1.2 times nominal."""
JUMP = 10.0
"""Beyond that speed, jumps of this many standard deviations of the noise."""
ASLEEP = 50.0
"""Predicted travel in a block, in standard deviations of the noise, that must be seen."""
SEEN_SHARE = 0.1
"""Share of it that must be seen at least: no parameter slows the shaft to a tenth while it still moves."""
TWICE = 2
"""Blocks in a row that must be missing before it is said."""


class SensorWatch:
    """Takes blocks as they come and says what is wrong with the sensor now."""

    def __init__(self, model: Model, offset_tolerance: float) -> None:
        """`offset_tolerance` is a fraction of the way between the stops."""
        self.model = model
        self.offset_tolerance = offset_tolerance
        self._scatters: deque[bool] = deque(maxlen=BASELINE)
        self._noises: deque[float] = deque(maxlen=LATEST_BLOCKS)
        self._learnt: list[float] = []
        self._spikes: deque[bool] = deque(maxlen=SPIKE_MEMORY)
        self._blocks: deque[Samples] = deque(maxlen=LATEST_BLOCKS)
        self._hold = (math.nan, 1.0, 0.0, 0.0)
        self._equal = 0
        self._asleep = 0
        self._count = 0

    def take(self, block: Samples, supply: float) -> list[Finding]:
        """Faults that show with this block; `supply` is the factor of an unlogged supply over the model's."""
        self._count += 1
        if not np.all(block.whole):
            self._blocks.clear()
            return []
        self._blocks.append(block)
        frozen, course = self._frozen(block), self._course(block, supply)
        found = [frozen, self._noisier(block, course), self._jumps(block)]
        if frozen is None:
            found.append(self._unmoved(block, course))
        if self._asleep == 0:
            found.append(self._offset(supply))
        return [finding for finding in found if finding is not None]

    @property
    def usual_noise(self) -> float:
        """Standard deviation of the sensor's noise when the watch began [rad]; 0 until it is learnt."""
        return float(np.median(self._learnt)) if len(self._learnt) == BASELINE else 0.0

    @property
    def _noise_now(self) -> float:
        """Standard deviation of the sensor's noise in the last second [rad]."""
        return float(np.median(self._noises))

    def _frozen(self, block: Samples) -> Finding | None:
        equal = bool(np.ptp(block.angle) == 0.0)
        usual = len(self._scatters) == BASELINE and sum(self._scatters) >= 0.9 * BASELINE
        if not equal or not usual:
            self._equal = 0
            self._scatters.append(not equal)
            return None
        self._equal += 1
        if self._equal < FROZEN:
            return None
        return _fault("frozen", f"sensor frozen at {block.angle[-1]:.4g} rad", self._blocks)

    def _noisier(self, block: Samples, course: Signal) -> Finding | None:
        # what the duty makes the shaft do is no noise, as where a loop hunts
        self._noises.append(math.sqrt(float(np.mean(np.diff(block.angle - course, 2) ** 2)) / 6.0))
        if len(self._learnt) < BASELINE:
            self._learnt.append(self._noises[-1])
            return None
        now = self._noise_now
        if now <= NOISE_RISE * self.usual_noise or self.usual_noise == 0.0:
            return None
        text = f"sensor noise is {now:.2g} rad RMS, {now / self.usual_noise:.1f} times what it was"
        return _fault("noise", text, self._blocks)

    def _jumps(self, block: Samples) -> Finding | None:
        value = self.model.values
        top = TOP_SPEED * value["supply_voltage"] / (value["gear_ratio"] * value["torque_constant"])
        passed = np.diff(block.time)
        far = np.abs(np.diff(block.angle)) > top * passed + JUMP * max(self.usual_noise, self._noise_now)
        self._spikes.append(bool(np.any(far)) and self.usual_noise > 0.0)
        if sum(self._spikes) < SPIKES:
            return None
        text = f"sensor jumps faster than the shaft can turn, in {sum(self._spikes)} of the last {SPIKE_MEMORY} blocks"
        return _fault("spikes", text, self._blocks)

    def _course(self, block: Samples, supply: float) -> Signal:
        """The angle [rad] that the model has under the duty of the block, shape (samples,), from where it begins."""
        start = float(np.mean(block.angle[: BLOCK_SAMPLES // 5]))
        if self._held(block, start, supply):
            return np.full(block.angle.size, start)
        course = predicted(self._supplied(supply), block, start, supply)
        if course[-1] == start:
            self._hold = (start, supply, float(np.min(block.duty)), float(np.max(block.duty)))
        return course

    def _unmoved(self, block: Samples, course: Signal) -> Finding | None:
        start, noise = float(course[0]), self.usual_noise
        travel = abs(float(course[-1]) - start)
        moved = abs(float(np.mean(block.angle[-BLOCK_SAMPLES // 5 :])) - start)
        missing = noise > 0.0 and travel > ASLEEP * noise and moved < SEEN_SHARE * travel
        self._asleep = self._asleep + 1 if missing else 0
        if self._asleep < TWICE:
            return None
        text = (
            f"the angle stays at {start:.3g} rad although the duty moves the model by {travel:.2g} rad "
            f"in {BLOCK_SAMPLES} samples: sensor stuck, shaft jammed or motor not driven"
        )
        return _fault("stuck", text, self._blocks)

    def _held(self, block: Samples, start: float, supply: float) -> bool:
        """Whether friction holds the model here under every duty of the block, as a block before has shown.

        Between two duties that leave the shaft where it is, all do; nearby is what the spring does not tell apart.
        """
        angle, before, low, high = self._hold
        near = abs(start - angle) < self.usual_noise and supply == before
        return near and low <= float(np.min(block.duty)) and float(np.max(block.duty)) <= high

    def _offset(self, supply: float) -> Finding | None:
        """Once for every row of blocks: at rest where the duty of that row drives the shaft onto a stop for certain."""
        lower, upper = self.model.actuator.lower_stop, self.model.actuator.upper_stop
        if self._count % LATEST_BLOCKS or len(self._blocks) < LATEST_BLOCKS or not math.isfinite(upper - lower):
            return None
        row = Samples.joined(list(self._blocks))
        means = row.angle.reshape(LATEST_BLOCKS, BLOCK_SAMPLES).mean(axis=1)
        end = float(predicted(self._supplied(supply), row, 0.5 * (lower + upper), supply)[-1])
        stop = next((s for s in (lower, upper) if abs(end - s) < 1e-6 * (upper - lower)), None)
        limit = self.offset_tolerance * (upper - lower)
        if stop is None or self.usual_noise == 0.0 or np.ptp(means) > 0.5 * limit + 2.0 * self.usual_noise:
            return None
        offset = float(np.mean(means)) - stop
        if abs(offset) <= limit:
            return None
        return _fault("offset", f"sensor offset of {offset:+.3g} rad at the stop at {stop:.4g} rad", self._blocks)

    def _supplied(self, supply: float) -> Model:
        if supply == 1.0:
            return self.model
        return self.model.with_values({"supply_voltage": self.model.values["supply_voltage"] * supply})


def _fault(name: str, text: str, blocks: deque[Samples]) -> Finding:
    return Finding("sensor", (name,), text, float(blocks[0].time[0]), float(blocks[-1].time[-1]))
