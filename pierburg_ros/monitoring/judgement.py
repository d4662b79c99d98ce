"""Judges the latest movements together: nothing to say, a drift, or physics that no parameter explains."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from pierburg_ros.monitoring.evidence import Evidence, evidence, predicted, scaled, watched
from pierburg_ros.monitoring.explanations import SUPPLY, Explanation, fitted, solved, supply_prior
from pierburg_ros.monitoring.findings import DEVIATIONS_99, Finding, drift, physics
from pierburg_ros.monitoring.movements import Movement, Samples
from pierburg_ros.plant import Model

RECENT = 6
"""Movements judged together: six of ten degrees leave a standard error of 1 to 3 % on each parameter of the valve."""
CERTAIN_GAIN = 27.0
"""Gain of a changed parameter, in variances, that is no chance.

At most one look a second, 86,400 a day, at six parameters: a chance of 0.1 false alarms a day allows 1.9e-7 each,
where chi-squared with one degree of freedom stands at 27. Looks share movements, so that there are fewer.
"""
BEYOND_SUPPLY = 9.0
"""The same for an unlogged supply: three times its spread."""
TIED_GAIN = 10.8
"""Difference in variances up to which another parameter explains as well: chi-squared, one degree, 0.1 %."""
LEFT = 0.25
"""Energy left, in variances of the sensor's noise, that is structure: half the noise, RMS.

Six movements have some 6,000 samples, whose mean square varies by 0.02 by chance; the noise is known to 3 %.
"""
PAUSE = 10.0
"""Least time [s] between two searches for an explanation, which take half a second of a core."""
LONG_PAUSE = 60.0
"""The same after two searches that found the same: it is looked at again, at 1 % of a core."""
NEW = 3
"""Least number of movements between them."""


class Judgement:
    """Keeps the latest movements with their evidence; `tolerance` is the drift that need not be said (fraction)."""

    def __init__(self, model: Model, tolerance: float, misfit_tolerance: float) -> None:
        self.model = model
        self.tolerance = tolerance
        self.misfit_tolerance = misfit_tolerance
        self.names = watched(model)
        self._supply = self.names.index(SUPPLY)
        self._pieces: deque[Evidence] = deque(maxlen=RECENT)
        self._left: deque[float] = deque(maxlen=RECENT)
        self._count = 0
        self._pause = PAUSE
        self._found: tuple[str, tuple[str, ...]] | None = None
        self._searched_at = (-np.inf, -NEW)
        self._left_since: int | None = None

    def forget(self) -> None:
        """Begin anew: what was measured before says nothing about now."""
        self._pieces.clear()
        self._left.clear()
        self._left_since = None

    @property
    def supply(self) -> float:
        """Factor of the supply over the model's at the last movement, as it explains the movements alone."""
        return float(np.exp(self._pieces[-1].about[self._supply])) if self._pieces else 1.0

    @property
    def movements(self) -> list[Movement]:
        """The movements judged."""
        return [piece.movement for piece in self._pieces]

    def take(self, movement: Movement) -> tuple[bool, Finding | None]:
        """Judge with one more movement: whether there was a judgement, and what it found."""
        about = np.zeros(len(self.names))
        known = is_known(movement)
        if self._pieces and not known:
            about[self._supply] = self._pieces[-1].about[self._supply]
        self._pieces.append(evidence(self.model, movement, self.names, about))
        self._follow_supply()
        self._left.append(self._aftermath())
        self._count += 1
        if len(self._pieces) < RECENT:
            return False, None
        if not self._doubtful():
            self._left_since = None
            return True, None
        end = float(movement.samples.time[-1])
        if end - self._searched_at[0] < self._pause or self._count - self._searched_at[1] < NEW:
            return False, None
        self._searched_at = (end, self._count)
        judged, finding = self._searched()
        found = None if finding is None else finding.same
        self._pause = LONG_PAUSE if found is not None and found == self._found else PAUSE
        self._found = found
        return judged, finding

    def _follow_supply(self) -> None:
        """Let the supply follow, and linearise anew where it has moved."""
        prior = supply_prior(self.movements, is_known(self._pieces[-1].movement))
        for _ in range(3):
            best, _ = solved(self._pieces, None, self._supply, prior)
            best = np.clip(best, -0.5, 0.5)
            moved = [i for i, piece in enumerate(self._pieces) if abs(piece.about[self._supply] - best[i + 1]) > 0.003]
            if not moved:
                return
            for i in moved:
                about = np.zeros(len(self.names))
                about[self._supply] = best[i + 1]
                self._pieces[i] = evidence(self.model, self._pieces[i].movement, self.names, about)

    def _aftermath(self) -> float:
        """Mean square of the last window's residual, with what follows the movement, in variances of the noise."""
        piece = self._pieces[-1]
        samples = full(piece.movement).samples
        model = scaled(self.model, self.names, piece.about)
        ratio = model.values[SUPPLY] / self.model.values[SUPPLY]
        residual = samples.angle - predicted(model, samples, piece.movement.start, ratio)
        return float(np.mean(residual**2)) / piece.movement.noise**2

    def _doubtful(self) -> bool:
        """Whether a search for explanations is worth its time: a slope that promises much, or too much left."""
        prior = supply_prior(self.movements, is_known(self._pieces[-1].movement))
        base = _promise(self._pieces, None, self._supply, prior)
        gains = [_promise(self._pieces, i, self._supply, prior) - base for i in range(len(self.names))]
        supply = abs(float(np.mean([piece.about[self._supply] for piece in self._pieces])))
        return max(gains) > 0.5 * CERTAIN_GAIN or float(np.mean(self._left)) > 1.0 + LEFT or supply > 0.25

    def _searched(self) -> tuple[bool, Finding | None]:
        movements, known = self.movements, is_known(self._pieces[-1].movement)
        none = fitted(self.model, movements, None, known)
        begin = np.concatenate([[0.0], none.supply])
        found = [fitted(self.model, movements, name, known, begin) for name in self.names]
        found.sort(key=lambda each: each.cost)
        scale = max(1.0, found[0].cost / found[0].samples)
        alike = [each for each in found if each.cost - found[0].cost < TIED_GAIN * scale]
        certain = BEYOND_SUPPLY if found[0].name == SUPPLY and not known else CERTAIN_GAIN
        if none.cost - found[0].cost < certain * scale:
            alike = [none]
        return self._concluded(none, alike, known)

    def _concluded(self, none: Explanation, alike: list[Explanation], known: bool) -> tuple[bool, Finding | None]:
        """Drift where one value explains motion and rest; physics where something stays, twice in a row."""
        movements = self.movements
        start, end = float(movements[0].samples.time[0]), float(movements[-1].samples.time[-1])
        whole = [self._refined(each, known) for each in alike]
        agreeing = [each for each, short in zip(whole, alike, strict=True) if self._agrees(each, short)]
        if agreeing:
            self._left_since = None
            agreeing.sort(key=lambda each: each.cost)
            scale = max(1.0, agreeing[0].cost / agreeing[0].samples)
            alike = [each for each in agreeing if each.cost - agreeing[0].cost < TIED_GAIN * scale]
            if alike[0].name is None or not self._matters(alike[0]):
                return True, None
            return True, drift(alike, known, start, end)
        if self._left_since is None:
            self._left_since = self._count
        if self._count - self._left_since < RECENT:
            return False, None
        best = min(whole, key=lambda each: each.cost)
        travel = float(np.mean([np.ptp(m.samples.angle) for m in movements]))
        return True, physics(best, self._misfit(best), travel, start, end)

    def _refined(self, explanation: Explanation, known: bool) -> Explanation:
        """The explanation fitted to what follows the movements too."""
        begin = np.concatenate([[explanation.change], explanation.supply])
        return fitted(self.model, [full(m) for m in self.movements], explanation.name, known, begin)

    def _misfit(self, explanation: Explanation) -> float:
        """What is left beyond the noise [rad RMS]."""
        noise = float(np.mean([movement.noise for movement in self.movements]))
        return noise * float(np.sqrt(max(explanation.cost / explanation.samples - 1.0, 0.0)))

    def _agrees(self, whole: Explanation, short: Explanation) -> bool:
        """Whether nothing is left that matters, and motion alone asks for the same value as motion with rest."""
        travel = float(np.mean([np.ptp(m.samples.angle) for m in self.movements]))
        leaves = whole.cost > (1.0 + LEFT) * whole.samples and self._misfit(whole) > self.misfit_tolerance * travel
        apart = abs(whole.change - short.change)
        return not leaves and not (apart > self.tolerance and apart > DEVIATIONS_99 * short.error)

    def _matters(self, explanation: Explanation) -> bool:
        """Whether the change is beyond the tolerance for certain."""
        if explanation.name == SUPPLY:
            return True
        return abs(explanation.change) - DEVIATIONS_99 * explanation.error > self.tolerance


def full(movement: Movement) -> Movement:
    """The movement with what follows it."""
    samples = Samples.joined([movement.samples, movement.aftermath])
    return replace(movement, samples=samples, aftermath=movement.aftermath.cut(0, 0))


def is_known(movement: Movement) -> bool:
    """Whether the supply was measured throughout."""
    return bool(np.all(np.isfinite(movement.samples.supply_voltage)))


def _promise(pieces: Sequence[Evidence], column: int | None, supply: int, prior: np.ndarray) -> float:
    """Cost that a change is expected to save, in variances."""
    best, covariance = solved(pieces, column, supply, prior)
    if column is None:
        best, covariance = best[1:], covariance[1:, 1:]
    return float(best @ np.linalg.solve(covariance, best))
