"""The torque balance of a shaft that turns round, from its motion: the lag of the input and the torque over a turn.

Nothing is simulated: at each sample, inertia, friction and a torque that repeats with every turn must make up the
torque of the motor. The balance is linear in all unknowns, so it takes milliseconds and has one minimum.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.arrays import Flags, Signal
from pierburg_ros.plant import Inputs, Model
from pierburg_ros.plant.decode import decoded
from pierburg_ros.plant.simulate import motor_torque
from pierburg_ros.plant.torques.missing import missing

WINDOW = 11
"""Number of samples around a moment from which angle, velocity and acceleration are computed. Derived: the velocity at
500 Hz is then known to 48 noises per second."""
SLOW_PART = 0.1
"""Share of the steps between samples that are finer than the step that sets the highest frequency. Chosen: the slow
tenth of a movement shows frequencies for which the rest is too fast."""
TURN = 2.0 * math.pi
"""Angle after which a shaft is at the same place again [rad]. Derived: one turn in radian."""
WHOLE = 0.9
"""Smallest share of a turn that must be measured for a map of it. Chosen: the orders determine the missing tenth."""
FALSE_ALARM = 0.01
"""Probability of a false alarm: a torque that wanders without a period is given one. Chosen: one recording in a
hundred."""
NEIGHBOURS = 12
"""Number of orders on either side that give the usual power around an order. Chosen: few enough for the spectrum to be
even there; not varied."""
MOST = 128
"""Highest order that is tested. Chosen: twice the 64 poles and slots at which the search of a ripple began."""
SAMPLES = 8
"""Smallest number of samples of the motion for each unknown. Chosen: neighbouring samples share most of their
window."""
ROUNDING = 1e-9
"""Number that is added to the diagonal of the normal equations. Derived: far above rounding, far below a column."""
OUTLYING = 12.0
"""Error, over the median of all errors, beyond which a sample is left out. Chosen: three times where white noise ends.
A shaft that is caught in motion or knocked lies beyond, one that slips does not."""
LATE = 0.5
"""Largest squared residual that a filter of the input may leave, as a share of that without a filter. Chosen: half; on
the rotor under a controller whose current is recorded behind a filter it is a quarter to a third (n = 3)."""


Part = tuple[Inputs, Signal, Signal, Flags]
"""The inputs, and for each sample its time [s], the measured value and whether it is used; each shape (samples,)."""


@dataclass(frozen=True)
class Balance:
    """The parts of the motor torque: `lag` [s] of its record, and `cosines` and `sines` [N.m] over a turn by `orders`.

    `friction` [N.m] resists movement at any speed. `resistance` [N.m] is all resistance to movement, on average over
    the way. `left` [N.m] is the root mean square of the residual torque.
    """

    lag: float
    orders: NDArray[np.int64]
    cosines: Signal
    sines: Signal
    friction: float
    resistance: float
    left: float

    @property
    def strongest(self) -> tuple[float, float, int]:
        """Cosine and sine [N.m] of the strongest order, and that order."""
        place = int(np.argmax(np.hypot(self.cosines, self.sines)))
        return float(self.cosines[place]), float(self.sines[place]), int(self.orders[place])

    @property
    def lesser(self) -> Balance:
        """The same balance without the strongest order."""
        rest = np.delete(np.arange(self.orders.size), np.argmax(np.hypot(self.cosines, self.sines)))
        return replace(self, orders=self.orders[rest], cosines=self.cosines[rest], sines=self.sines[rest])

    def torque(self, angle: Signal) -> Signal:
        """Load torque over a turn [N.m] without its mean, at each `angle` [rad]; positive closes."""
        turns = np.outer(angle, self.orders)
        return np.asarray(np.cos(turns) @ self.cosines + np.sin(turns) @ self.sines)


@dataclass(frozen=True)
class _Motion:
    """Samples at even steps, each shape (samples,): time [s], angle [rad], its derivatives and torques [N.m].

    `torque` is the motor torque beyond the known load, `rate` the derivative of the whole motor torque. `weight`: a
    weight hangs on the shaft.
    """

    time: Signal
    angle: Signal
    velocity: Signal
    acceleration: Signal
    torque: Signal
    rate: Signal
    weight: bool

    def kept(self, which: Flags) -> _Motion:
        return replace(self, **{name: getattr(self, name)[which] for name in SIGNALS})

    @staticmethod
    def of_all(motions: Sequence[_Motion]) -> _Motion:
        """All `motions`, one after the other."""
        joined: dict[str, Any] = {name: np.concatenate([getattr(each, name) for each in motions]) for name in SIGNALS}
        return replace(motions[0], **joined)


SIGNALS = ("time", "angle", "velocity", "acceleration", "torque", "rate")


def goes_round(model: Model, measured: Signal, quantity: str) -> bool:
    """Whether a shaft without stops, driven by a current or torque, is measured over most of a turn."""
    actuator = model.actuator
    free = math.isinf(actuator.upper_stop - actuator.lower_stop) and actuator.motion == "rotary"
    if not free or actuator.drive == "voltage" or quantity != "position" or measured.size <= 2 * WINDOW:
        return False
    return float(np.ptp(decoded(model, measured, quantity))) >= WHOLE * TURN


def recorded_lag(model: Model, inputs: Inputs, time: Signal, measured: Signal) -> float:
    """Time constant [s] of the filter behind which the input was recorded; 0 unless it explains enough (`LATE`).

    A smoothed current sensor shows the torque that holds the shaft at an angle a moment later.
    """
    motion = _motion(model, inputs, time, measured)
    late, inside = _balanced(motion, True)
    plain, _ = _balanced(motion, False, inside)
    return late.lag if late.lag > 0.0 and late.left**2 < LATE * plain.left**2 else 0.0


def ahead(inputs: Inputs, lag: float) -> Inputs:
    """The inputs that a first-order filter with a time constant of `lag` [s] would record as `inputs`."""
    if lag == 0.0 or inputs.command.size < WINDOW:
        return inputs
    step = float(np.median(np.diff(inputs.time)))
    return replace(inputs, command=inputs.command + lag * _derivative(inputs.command, 1, step))


def over_a_turn(model: Model, parts: Sequence[Part]) -> Balance:
    """The balance of the motor torque in all `parts` of recordings together."""
    return _balanced(_Motion.of_all(_motions(model, parts)), False)[0]


def left_unseen(model: Model, told: Sequence[Part], unseen: Sequence[Part]) -> tuple[float, float]:
    """Residual motor torque [N.m, root mean square] on `unseen` samples, fitted to the samples of `told`.

    The first value is without a torque over a turn, the second with the orders found in `told`. Both are not a number
    where there are no unseen samples.
    """
    seen, others = (_Motion.of_all(_motions(model, parts)) for parts in (told, unseen))
    orders = _balanced(seen, False)[0].orders.tolist()

    def left(columns: Sequence[int]) -> float:
        fitted = _least_squares(_columns(seen, columns), seen.torque)
        rest = others.torque - _columns(others, columns) @ fitted
        return float(np.sqrt(np.mean(np.square(rest)))) if rest.size else math.nan

    return left([]), left(orders)


def finest(place: Signal) -> float:
    """The highest frequency [1 / unit of place] that samples at `place` resolve, two to a period; 0 where it rests."""
    steps = np.abs(np.diff(place))
    steps = steps[steps > 0.0]
    return 0.5 / float(np.quantile(steps, SLOW_PART)) if steps.size else 0.0


def _derivative(values: Signal, order: int, step: float) -> Signal:
    """The derivative of some order, by cubics through `WINDOW` samples that are a `step` [s] apart; order 0 smooths."""
    from scipy.signal import savgol_filter  # takes long to load, and most actuators need none

    return np.asarray(savgol_filter(values, WINDOW, 3, deriv=order, delta=step))


def _motion(model: Model, inputs: Inputs, time: Signal, measured: Signal) -> _Motion:
    """The motion at every `WINDOW // 4` even steps; derivatives are those of cubics through `WINDOW` samples."""
    step = float(np.median(np.diff(time)))
    even = np.arange(time[0], time[-1], step)
    shown = np.interp(even, time, decoded(model, measured, "position"))
    driven = np.interp(even, time, motor_torque(model, inputs, time))
    still = np.zeros(even.size)
    lacking = missing(model.record()[0], driven, even, shown, still, still)

    def derived(values: Signal, order: int) -> Signal:
        return _derivative(values, order, step)[:: WINDOW // 4]

    return _Motion(
        time=even[:: WINDOW // 4],
        angle=derived(shown, 0),
        velocity=derived(shown, 1),
        acceleration=derived(shown, 2),
        torque=derived(lacking, 0),
        rate=derived(driven, 1),
        weight=model.values.get("gravity_torque", 0.0) != 0.0,
    )


def _motions(model: Model, parts: Sequence[Part]) -> list[_Motion]:
    """The motion of each part at the samples that are used."""
    motions = []
    for inputs, time, measured, seen in parts:
        motion = _motion(model, inputs, time, measured)
        motions.append(motion.kept(np.interp(motion.time, time, seen.astype(float)) > 0.99))
    return motions


def _columns(motion: _Motion, orders: Sequence[int]) -> Signal:
    """Columns of the fit, shape (samples, columns): friction, inertia, a weight, and some orders of a turn."""
    columns = [np.ones(motion.time.size), np.sign(motion.velocity), motion.velocity, motion.acceleration]
    if motion.weight:
        # weight and axis may differ from the description: once in a turn
        columns += [np.cos(motion.angle), np.sin(motion.angle)]
    for order in orders:
        columns += [np.cos(order * motion.angle), np.sin(order * motion.angle)]
    return np.stack(columns, axis=1)


def _balanced(motion: _Motion, lagged: bool, inside: Flags | None = None) -> tuple[Balance, Flags]:
    """The balance by least squares, and the samples that it uses, shape (samples,).

    Order by order, it adds the one that stands out most, until chance may raise one as far. The samples are those
    `inside` if given, otherwise all but outliers.
    """
    known = _columns(motion, ())
    if lagged:
        known = np.concatenate([known, -motion.rate[:, np.newaxis]], axis=1)
    first, highest = known.shape[1], min(int(TURN * finest(motion.angle)), MOST)
    turns = np.outer(motion.angle, np.arange(1, highest + NEIGHBOURS + 1))
    cosines, sines = np.cos(turns), np.sin(turns)
    kept = np.ones(motion.time.size, dtype=bool) if inside is None else inside
    orders: list[int] = []
    while True:
        found = _least_squares(known[kept], motion.torque[kept])
        left = motion.torque - known @ found
        kept = np.abs(left) <= OUTLYING * np.median(np.abs(left)) if inside is None else inside
        taken = [*orders, *([1] if motion.weight else [])]
        order = _next_order(left[kept] @ cosines[kept], left[kept] @ sines[kept], highest, taken)
        if order == 0 or known.shape[1] > motion.time.size // SAMPLES:
            break
        orders.append(order)
        known = np.concatenate([known, cosines[:, order - 1 : order], sines[:, order - 1 : order]], axis=1)
    lag = float(found[first - 1]) if lagged else 0.0
    cosine, sine = found[first::2], found[first + 1 :: 2]
    friction = max(float(found[1] + found[0] * np.mean(known[kept, 1])), 0.0)
    way = float(np.sum(np.abs(motion.velocity[kept])))
    resistance = float(known[kept, :3] @ found[:3] @ motion.velocity[kept]) / way if way > 0.0 else 0.0
    return Balance(
        lag, np.array(orders, dtype=np.int64), cosine, sine, friction, resistance, float(np.std(left[kept]))
    ), kept


def _least_squares(known: Signal, wanted: Signal) -> Signal:
    """Solution of the normal equations of columns scaled to one; coefficients that are not distinguished stay small."""
    scale = np.linalg.norm(known, axis=0) + 1e-300
    scaled = known / scale
    gram = scaled.T @ scaled + ROUNDING * np.eye(scale.size)
    return np.asarray(np.linalg.solve(gram, scaled.T @ wanted) / scale)


def _next_order(cosine: Signal, sine: Signal, highest: int, taken: list[int]) -> int:
    """The order that stands out most from its neighbours and is not `taken`; 0 where chance may raise one as far."""
    from scipy.ndimage import median_filter  # takes long to load, and most actuators need none

    power = np.square(cosine) + np.square(sine)
    usual = median_filter(power, 2 * NEIGHBOURS + 1, mode="nearest") / math.log(2.0)
    height = power / (usual + 1e-300)
    height[highest:] = 0.0
    height[np.array(taken, dtype=int) - 1] = 0.0
    best = int(np.argmax(height))
    return best + 1 if highest > 0 and height[best] >= _least_height(highest) else 0


def _least_height(orders: int) -> float:
    """Ratio to its neighbours that one of so many `orders` exceeds by chance once in 1 / `FALSE_ALARM`.

    The power of an order without a period is distributed exponentially. Its ratio to the mean of n others exceeds z
    with the probability (1 + z / n)^-n. A median of twice as many orders gives that mean about as well.
    """
    return NEIGHBOURS * (math.pow(orders / FALSE_ALARM, 1.0 / NEIGHBOURS) - 1.0)
