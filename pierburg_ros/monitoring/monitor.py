"""The monitor of one actuator: samples in, findings that begin and end out."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from pierburg_ros.monitoring.evidence import predicted
from pierburg_ros.monitoring.findings import Finding
from pierburg_ros.monitoring.judgement import Judgement
from pierburg_ros.monitoring.movements import Blocks, Movements, Samples
from pierburg_ros.monitoring.sensor import SensorWatch
from pierburg_ros.plant import Model

FORGIVEN = 3
"""Judgements without a finding after which the last one is over."""
MENDED = 10.0
"""Time without a sensor's fault after which it is over [s]."""
UNSETTLED = 3.0
"""Time after a sensor's fault in which movements are not judged [s]: their windows last 2 s at most."""


@dataclass(frozen=True)
class Change:
    """A finding that begins, or one that is over."""

    finding: Finding
    begins: bool


class Monitor:
    """Follows an actuator. `findings` are those in force."""

    def __init__(
        self, model: Model, tolerance: float = 0.05, misfit_tolerance: float = 0.003, offset_tolerance: float = 0.01
    ) -> None:
        """Tolerances: drift of a parameter, misfit as part of the travel, offset as part of the way between stops."""
        self.judgement = Judgement(model, tolerance, misfit_tolerance)
        self.sensor = SensorWatch(model, offset_tolerance)
        self.movements = 0
        self._blocks = Blocks()
        self._windows = Movements()
        self._faults: dict[tuple[str, ...], Finding] = {}
        self._actuator: Finding | None = None
        self._clear = 0

    @property
    def findings(self) -> list[Finding]:
        """What is wrong now."""
        return [*self._faults.values(), *([self._actuator] if self._actuator else [])]

    @property
    def noise(self) -> float:
        """Standard deviation of the sensor's noise now [rad]."""
        return self._windows.noise

    def prepare(self) -> None:
        """Compile, or load, the simulator before the first sample comes."""
        time, rest = np.array([0.0, 0.001]), np.zeros(2)
        samples = Samples(time, rest, rest, np.full(2, np.nan), np.ones(2, dtype=bool))
        predicted(self.judgement.model, samples, 0.0)

    def take(self, samples: Samples) -> list[Change]:
        """Changes that these samples bring."""
        return [change for block in self._blocks.take(samples) for change in self._take(block)]

    def _take(self, block: Samples) -> list[Change]:
        now = float(block.time[-1])
        changes = [self._fault(each) for each in self.sensor.take(block, self.judgement.supply)]
        over = [name for name, fault in self._faults.items() if now - fault.end > MENDED]
        changes += [Change(self._faults.pop(name), False) for name in over]
        movement = self._windows.take(block)
        if self._unsettled(now):
            self.judgement.forget()
        elif movement is not None:
            self.movements += 1
            changes += self._judged(*self.judgement.take(movement))
        return [change for change in changes if change is not None]

    def _unsettled(self, now: float) -> bool:
        """Whether a fault of the sensor makes movements worthless; an offset shifts them all alike and does not."""
        return any(now - f.end < UNSETTLED and name != ("offset",) for name, f in self._faults.items())

    def _fault(self, finding: Finding) -> Change | None:
        known = finding.names in self._faults
        self._faults[finding.names] = finding
        return None if known else Change(finding, True)

    def _judged(self, judged: bool, finding: Finding | None) -> list[Change]:
        if not judged:
            return []
        before = self._actuator
        if finding is None:
            self._clear += 1
            if before is None or self._clear < FORGIVEN:
                return []
            self._actuator = None
            return [Change(before, False)]
        self._clear = 0
        if before is None:
            self._actuator = finding
            return [Change(finding, True)]
        if before.kind == finding.kind and set(finding.names) <= set(before.names):
            return []
        self._actuator = finding
        return [Change(before, False), Change(finding, True)]
