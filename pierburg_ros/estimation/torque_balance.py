"""The balance of torques of a shaft that turns round, read from its motion: what it says of the input and of a turn.

Nothing is simulated: inertia, friction and a torque that repeats itself with every turn have to make up the torque of
the motor, sample by sample. It is linear in all that is unknown, so it takes milliseconds, and has one minimum.
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
"""Samples around a moment from which angle, velocity and acceleration are read. Derived: the velocity at 500 Hz is
then known to 48 noises per second."""
SLOW_PART = 0.1
"""Share of the steps between samples that are finer than the one by which the highest frequency is told. Chosen: the
slow tenth of a movement shows what the rest is too fast for."""
TURN = 2.0 * math.pi
"""Angle after which a shaft is where it was [rad]. Derived: one turn in radian."""
WHOLE = 0.9
"""Share of a turn that a shaft has to be seen in for a map of it. Chosen: the rest of its orders tell the tenth."""
FALSE_ALARM = 0.01
"""Chance at which a torque that wanders without a rhythm is given one. Chosen: one recording in a hundred."""
NEIGHBOURS = 12
"""Orders to either side that say what a spectrum is beside one of them. Chosen: few enough for it to be even there; not
varied."""
MOST = 128
"""Highest order that is looked for. Chosen: twice the 64 poles and slots at which the search of a ripple began."""
SAMPLES = 8
"""Samples of the motion for each unknown, at least. Chosen: those beside each other share most of their window."""
ROUNDING = 1e-9
"""What is added to the diagonal of the normal equations. Derived: far above rounding, far below a column."""
OUTLYING = 12.0
"""Error, over the median of all, beyond which a sample is left out. Chosen: three times where white noise ends; a
shaft that is caught in motion or knocked lies beyond, one that slips does not."""
LATE = 0.5
"""Share of what is left without it up to which a filter of the input must bring it. Chosen: half; on the rotor under a
controller whose current is recorded behind one it is a quarter to a third (n = 3)."""


Part = tuple[Inputs, Signal, Signal, Flags]
"""Inputs, and of each sample its time [s], what was measured, and whether it is seen; each shape (samples,)."""


@dataclass(frozen=True)
class Balance:
    """What makes up the motor torque: `lag` [s] of its record, and over a turn `cosines` and `sines` [N.m] by `orders`.

    `friction` [N.m] is what resists movement at any speed, `resistance` [N.m] all that resists it, on average over its
    way; `left` the root mean square [N.m] of what nothing makes up.
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
        """Cosine and sine [N.m] of the strongest order, and which it is."""
        place = int(np.argmax(np.hypot(self.cosines, self.sines)))
        return float(self.cosines[place]), float(self.sines[place]), int(self.orders[place])

    @property
    def lesser(self) -> Balance:
        """The same without the strongest order."""
        rest = np.delete(np.arange(self.orders.size), np.argmax(np.hypot(self.cosines, self.sines)))
        return replace(self, orders=self.orders[rest], cosines=self.cosines[rest], sines=self.sines[rest])

    def torque(self, angle: Signal) -> Signal:
        """Load torque over a turn [N.m] at each `angle` [rad], positive closes, its mean left out."""
        turns = np.outer(angle, self.orders)
        return np.asarray(np.cos(turns) @ self.cosines + np.sin(turns) @ self.sines)


@dataclass(frozen=True)
class _Motion:
    """Samples at even steps: time [s], angle [rad], velocity, acceleration, motor torque beyond the known load [N.m],
    and the rate of all of it; whether a `weight` hangs on the shaft."""

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
        """One after the other."""
        joined: dict[str, Any] = {name: np.concatenate([getattr(each, name) for each in motions]) for name in SIGNALS}
        return replace(motions[0], **joined)


SIGNALS = ("time", "angle", "velocity", "acceleration", "torque", "rate")


def goes_round(model: Model, measured: Signal, quantity: str) -> bool:
    """Whether a shaft without stops, driven by a current or torque, is seen in most of a turn."""
    actuator = model.actuator
    free = math.isinf(actuator.upper_stop - actuator.lower_stop) and actuator.motion == "rotary"
    if not free or actuator.drive == "voltage" or quantity != "position" or measured.size <= 2 * WINDOW:
        return False
    return float(np.ptp(decoded(model, measured, quantity))) >= WHOLE * TURN


def recorded_lag(model: Model, inputs: Inputs, time: Signal, measured: Signal) -> float:
    """Time constant [s] of the filter behind which the input was recorded; 0 unless that leaves half as much (`LATE`).

    A current sensor that is smoothed shows the torque that holds the shaft at an angle a moment later.
    """
    motion = _motion(model, inputs, time, measured)
    late, inside = _balanced(motion, True)
    plain, _ = _balanced(motion, False, inside)
    return late.lag if late.lag > 0.0 and late.left**2 < LATE * plain.left**2 else 0.0


def ahead(inputs: Inputs, lag: float) -> Inputs:
    """The inputs that a first-order filter with a time constant of `lag` [s] would record as these."""
    if lag == 0.0 or inputs.command.size < WINDOW:
        return inputs
    step = float(np.median(np.diff(inputs.time)))
    return replace(inputs, command=inputs.command + lag * _derivative(inputs.command, 1, step))


def over_a_turn(model: Model, parts: Sequence[Part]) -> Balance:
    """What makes up the motor torque in all `parts` of recordings together."""
    return _balanced(_Motion.of_all(_motions(model, parts)), False)[0]


def left_unseen(model: Model, told: Sequence[Part], unseen: Sequence[Part]) -> tuple[float, float]:
    """What is left of the motor torque [N.m, root mean square] on `unseen` samples, fitted to those that are `told`.

    Without a torque over a turn, and with the orders that the latter tell; not a number where nothing is unseen.
    """
    seen, others = (_Motion.of_all(_motions(model, parts)) for parts in (told, unseen))
    orders = _balanced(seen, False)[0].orders.tolist()

    def left(columns: Sequence[int]) -> float:
        fitted = _least_squares(_columns(seen, columns), seen.torque)
        rest = others.torque - _columns(others, columns) @ fitted
        return float(np.sqrt(np.mean(np.square(rest)))) if rest.size else math.nan

    return left([]), left(orders)


def finest(place: Signal) -> float:
    """The highest frequency [1 / unit of place] that samples at `place` tell, two to a period; 0 where it rests."""
    steps = np.abs(np.diff(place))
    steps = steps[steps > 0.0]
    return 0.5 / float(np.quantile(steps, SLOW_PART)) if steps.size else 0.0


def _derivative(values: Signal, order: int, step: float) -> Signal:
    """The derivative of some order, by cubics through `WINDOW` samples a `step` apart; order 0 smooths."""
    from scipy.signal import savgol_filter  # takes long to load, and most actuators need none

    return np.asarray(savgol_filter(values, WINDOW, 3, deriv=order, delta=step))


def _motion(model: Model, inputs: Inputs, time: Signal, measured: Signal) -> _Motion:
    """The motion at even steps, its derivatives from cubics through `WINDOW` samples, four steps to each."""
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
    """The motion of each part where it is seen."""
    motions = []
    for inputs, time, measured, seen in parts:
        motion = _motion(model, inputs, time, measured)
        motions.append(motion.kept(np.interp(motion.time, time, seen.astype(float)) > 0.99))
    return motions


def _columns(motion: _Motion, orders: Sequence[int]) -> Signal:
    """What may make up the torque, shape (samples, columns): friction, inertia, a weight, and some orders of a turn."""
    columns = [np.ones(motion.time.size), np.sign(motion.velocity), motion.velocity, motion.acceleration]
    if motion.weight:
        # its own or its axis may be other than described: once in a turn
        columns += [np.cos(motion.angle), np.sin(motion.angle)]
    for order in orders:
        columns += [np.cos(order * motion.angle), np.sin(order * motion.angle)]
    return np.stack(columns, axis=1)


def _balanced(motion: _Motion, lagged: bool, inside: Flags | None = None) -> tuple[Balance, Flags]:
    """Least squares, order by order: the one that stands out most, while chance would hardly raise any so far.

    Also which samples are `inside`, and not left out. Those are the given ones, or those that lie close enough.
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
    """Solution of the normal equations of columns scaled to one; what is not told apart stays small."""
    scale = np.linalg.norm(known, axis=0) + 1e-300
    scaled = known / scale
    gram = scaled.T @ scaled + ROUNDING * np.eye(scale.size)
    return np.asarray(np.linalg.solve(gram, scaled.T @ wanted) / scale)


def _next_order(cosine: Signal, sine: Signal, highest: int, taken: list[int]) -> int:
    """The order, none that is `taken`, that stands out most from those beside it; 0 where chance raises one so far."""
    from scipy.ndimage import median_filter  # takes long to load, and most actuators need none

    power = np.square(cosine) + np.square(sine)
    usual = median_filter(power, 2 * NEIGHBOURS + 1, mode="nearest") / math.log(2.0)
    height = power / (usual + 1e-300)
    height[highest:] = 0.0
    height[np.array(taken, dtype=int) - 1] = 0.0
    best = int(np.argmax(height))
    return best + 1 if highest > 0 and height[best] >= _least_height(highest) else 0


def _least_height(orders: int) -> float:
    """How far above its neighbours chance raises one of so many `orders` once in 1 / `FALSE_ALARM`.

    The power of an order without a rhythm is distributed exponentially, and its ratio to the mean of n others exceeds z
    with the chance (1 + z / n)^-n. A median of twice as many tells that mean about as well.
    """
    return NEIGHBOURS * (math.pow(orders / FALSE_ALARM, 1.0 / NEIGHBOURS) - 1.0)
