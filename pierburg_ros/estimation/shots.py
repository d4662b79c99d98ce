"""Stretches of a simulation whose initial states are fitted to the samples."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.plant import Inputs, Model
from pierburg_ros.plant.simulate import simulate_stretches

MOVES = 2
"""Number of steps by which every initial state is fitted. Work: each costs one more simulation; the second gains where
the first was far. Not varied."""
AGAIN = 3
"""Number of further steps for stretches in which one more step still predicts a gain. Work: the simulation of a few
stretches; with 4 and 5 steps none of n = 64 recordings of a pendulum that sticks was fitted better."""
PROMISED = 0.01
"""Predicted decrease of the squared error of a stretch, as a share, from which it gets further steps. Measured: at the
true values 2 % of the stretches do, and none keeps an error beyond its noise (n = 64 recordings of a pendulum that
sticks). Without further steps, 7 of the recordings have such an error."""
BACK = 0.3
"""Part of a step that is taken after a step that did not gain. Chosen: below a half, since a shaft that sticks on the
way breaks loose soon or not at all; not varied."""
TRUST = 3.0
"""Number of standard deviations of its estimate by which an initial state may be moved freely; a larger move costs as a
residual does. Measured: held within 5 or 30 of them, identified AK80 and ODrive runs keep up to 1.4 to 3.2 times the
error (n = 5). The steps of a real encoder are not white noise."""


@dataclass(frozen=True)
class Shots:
    """Stretches from samples `first`, each with its initial state, the error of that, and the reading of a slow sensor.

    Angles [rad] and velocities [rad/s] have shape (stretches,); `noise` is that of the samples [measured unit].
    """

    model: Model
    inputs: Inputs
    time: Signal
    measured: Signal
    quantity: str
    noise: float
    first: np.ndarray
    angle: Signal
    velocity: Signal
    angle_error: Signal
    velocity_error: Signal
    shown: Signal

    def suited(self) -> Signal:
        """The simulation from the initial states that fit the samples best, shape (samples,)."""
        best, move, promised = self._moved(np.zeros((2, self.first.size)), MOVES)
        again = np.flatnonzero(promised > PROMISED * self._sums(np.square(self.measured - best)))
        if again.size:
            # friction holds a shaft or lets it go: slopes from where it was held are useless
            samples, some = self._only(again)
            best[samples], _, _ = some._moved(move[:, again], AGAIN)
        return best

    def _only(self, which: np.ndarray) -> tuple[np.ndarray, Shots]:
        """The indices of the samples of some stretches, and these stretches alone."""
        ends = np.append(self.first, self.time.size)
        spans = [np.arange(ends[each], ends[each + 1]) for each in which.tolist()]
        samples, lengths = np.concatenate(spans), [span.size for span in spans]
        names = ("angle", "velocity", "angle_error", "velocity_error", "shown")
        states = {name: getattr(self, name)[which] for name in names}
        first = np.cumsum([0, *lengths[:-1]])
        return samples, replace(self, time=self.time[samples], measured=self.measured[samples], first=first, **states)

    def _moved(self, move: Signal, moves: int) -> tuple[Signal, Signal, Signal]:
        """The best simulation after some steps, its move, and the decrease of its error that one more step predicts.

        A `move` has shape (2, stretches), in standard deviations of angle and velocity.
        """
        lengths = np.diff(np.append(self.first, self.time.size))
        best = self._shot(move)
        slopes = [self._shot(move + np.array(one)[:, np.newaxis]) - best for one in ((1.0, 0.0), (0.0, 1.0))]
        error, part = self._sums(np.square(self.measured - best)), np.ones(self.first.size)
        for _ in range(moves):
            step, _ = self._step(self.measured - best, *slopes)
            further = move + part * step
            moved = self._shot(further)
            reached = self._sums(np.square(self.measured - moved))
            better = reached < error
            best = np.where(np.repeat(better, lengths), moved, best)
            error, move = np.where(better, reached, error), np.where(better, further, move)
            part = np.where(better, 1.0, BACK * part)
        return best, move, self._step(self.measured - best, *slopes)[1]

    def _shot(self, move: Signal) -> Signal:
        """The simulation from moved initial states, shape (samples,)."""
        angle, velocity = move[0] * self.angle_error, move[1] * self.velocity_error
        # the reading of a slow sensor moves with the state: otherwise it would swing towards it within the lag
        shown = self.shown + (velocity if self.quantity == "speed" else angle)
        none = np.zeros(self.first.size)
        starts = np.stack([self.angle + angle, self.velocity + velocity, none, none], axis=1)
        return simulate_stretches(self.model, self.inputs, self.time, self.first, starts, shown)

    def _step(self, residual: Signal, by_angle: Signal, by_velocity: Signal) -> tuple[Signal, Signal]:
        """Least-squares step of each initial state, in standard deviations, shape (2, stretches), and its gain."""
        sums = self._sums
        trust = (self.noise / TRUST) ** 2
        aa, vv = sums(by_angle**2) + trust, sums(by_velocity**2) + trust
        av, ra, rv = sums(by_angle * by_velocity), sums(residual * by_angle), sums(residual * by_velocity)
        step = np.array([vv * ra - av * rv, aa * rv - av * ra]) / (aa * vv - av * av)
        return step, step[0] * ra + step[1] * rv

    def _sums(self, values: Signal) -> Signal:
        """Sum of `values` over each stretch, shape (stretches,); a very large number where they are not numbers."""
        return np.asarray(np.add.reduceat(np.nan_to_num(values, nan=1e6), self.first))
