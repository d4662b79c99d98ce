"""The torque that repeats with every turn of a shaft: its orders, read off the balance along the measured motion."""

from __future__ import annotations

import math

import numpy as np

from pierburg_ros.arrays import Flags, Signal
from pierburg_ros.inference.balance import OUTLYING, missing
from pierburg_ros.inference.data import Data, Run
from pierburg_ros.inference.motion import WIDTH, Motion, motion_of
from pierburg_ros.plant import Model
from pierburg_ros.plant.decode import decoded
from pierburg_ros.plant.parameters import RESIDUAL_ANGLES

TURN_WINDOW = 11
"""Number of samples in the filter of the motion. Derived: the velocity at 500 Hz is then known to 48 noises per second,
and an order that passes in fewer samples than these is not seen."""
WHOLE_TURN = 2.0 * math.pi
"""Angle after which a shaft is at the same place again [rad]. Derived: one turn in radian."""
WHOLE = 0.9
"""Smallest share of a turn that must be measured for a map of it. Chosen: the orders determine the missing tenth."""
FALSE_ALARM = 0.01
"""Probability of a false alarm: a torque that wanders without a period is given one. Chosen: one recording in a
hundred."""
NEIGHBOURS = 12
"""Number of orders on either side that give the usual power around an order. Chosen: few enough for the spectrum to be
even there; not varied."""
HIGHEST_ORDER = 128
"""Highest order that is tested. Chosen: twice the 64 poles and slots that rotors usually have at most."""
SLOW_PART = 0.1
"""Share of the steps between samples that are finer than the step that sets the highest order. Chosen: the slow tenth
of a movement shows orders for which the rest is too fast."""
MOMENTS_EACH = 8
"""Smallest number of moments for each unknown. Chosen: neighbouring moments share most of their window."""
MENTIONED = 4
"""Number of orders that are named in words. Chosen: a sentence holds no more; the map holds all."""
SMALLEST_NAMED = 0.01
"""Smallest amplitude of an order that is named, as a share of the strongest. Chosen: a smaller one is not visible
beside it."""


def with_turn(data: Data, model: Model) -> Model | None:
    """`model` with the torque over a turn that it lacks, at most one of its own; None where none repeats with the turn.

    Every recording that turns round must show an order by itself: what wanders can be mistaken for one.
    """
    turning = [run for run in data.runs if goes_round(model, run)]
    motions = [motion_of(run, model, TURN_WINDOW * float(np.median(np.diff(run.time))) / WIDTH) for run in turning]
    if not motions or not all(orders_of([motion], model)[0] for motion in motions):
        return None
    orders, cosines, sines = orders_of(motions, model)
    angle = np.linspace(0.0, WHOLE_TURN, RESIDUAL_ANGLES)
    turns = np.outer(angle, orders)
    torque = np.cos(turns) @ cosines + np.sin(turns) @ sines
    return model.with_residual(
        {"angle": angle, "velocity": np.zeros(1), "torque": torque[:, np.newaxis], "period": WHOLE_TURN}
    )


def goes_round(model: Model, run: Run) -> bool:
    """Whether a shaft without stops, driven by a current or torque, is measured over most of a turn."""
    actuator = model.actuator
    free = math.isinf(actuator.upper_stop - actuator.lower_stop) and actuator.motion == "rotary"
    if not free or actuator.drive == "voltage" or actuator.quantity != "position" or run.time.size <= 2 * TURN_WINDOW:
        return False
    return float(np.ptp(decoded(model, run.measured))) >= WHOLE * WHOLE_TURN


def orders_of(motions: list[Motion], model: Model) -> tuple[list[int], Signal, Signal]:
    """Orders of a load torque over a turn, and the cosine and sine [N.m] of each.

    Order by order, the one that stands out most is added, until chance may raise one as far.
    """
    wanted = np.concatenate([missing(each, model.values, model.active_effects) for each in motions])
    hanging = [1] if model.values.get("gravity_torque", 0.0) else []
    known = np.concatenate([_columns(each, hanging) for each in motions])
    highest = min(_finest(motions), HIGHEST_ORDER)
    tested = range(1, highest + NEIGHBOURS + 1)
    ripples = [np.concatenate([each.ripple(order) for each in motions], axis=1) for order in tested]
    kept, orders = np.ones(wanted.size, dtype=bool), list[int]()
    while True:
        found = _least_squares(known, wanted, kept)
        left = wanted - known @ found
        kept = np.abs(left) <= 2.0 * OUTLYING * np.median(np.abs(left))
        power = np.array([float(np.sum(np.square(ripple[:, kept] @ left[kept]))) for ripple in ripples])
        order = _next_order(power, highest, [*hanging, *orders])
        if order == 0 or known.shape[1] > wanted.size // MOMENTS_EACH:
            return orders, found[-2 * len(orders) :: 2], found[-2 * len(orders) + 1 :: 2]
        orders.append(order)
        sine, cosine = ripples[order - 1]
        known = np.column_stack([known, cosine, sine])


def described_turn(torque: Signal, unit: str) -> str:
    """The strongest orders of a `torque` over a turn, shape (angles, 1), in words."""
    amplitude = 2.0 * np.abs(np.fft.rfft(torque[:-1, 0])) / (torque.shape[0] - 1)
    least = SMALLEST_NAMED * float(np.max(amplitude))
    strongest = [order for order in np.argsort(amplitude)[::-1][:MENTIONED] if amplitude[order] > least]
    orders = ", ".join(f"{amplitude[order]:#.2g} {unit} {order} times" for order in strongest)
    return f"it repeats itself with every turn, with {orders}"


def _columns(motion: Motion, hanging: list[int]) -> Signal:
    """What else may be wrong of a model, shape (samples, columns): offset, friction, inertia and a weight."""
    columns = [np.ones(motion.samples.size), motion.direction, motion.velocity, motion.acceleration]
    for order in hanging:
        columns += motion.ripple(order)
    return np.stack(columns, axis=1)


def _finest(motions: list[Motion]) -> int:
    """The highest order that the samples resolve, two to a period; 0 where the shaft rests."""
    steps = np.concatenate([np.abs(np.diff(each.angle)) for each in motions])
    steps = steps[steps > 0.0]
    return int(0.5 * WHOLE_TURN / float(np.quantile(steps, SLOW_PART))) if steps.size else 0


def _least_squares(known: Signal, wanted: Signal, kept: Flags) -> Signal:
    """Coefficients of columns by the samples that are kept, shape (columns,)."""
    scale = np.linalg.norm(known, axis=0) + 1e-300
    return np.asarray(np.linalg.lstsq(known[kept] / scale, wanted[kept], rcond=1e-6)[0] / scale)


def _next_order(power: Signal, highest: int, taken: list[int]) -> int:
    """The order that stands out most from its neighbours and is not `taken`; 0 where chance may raise one as far.

    The power of an order without a period is distributed exponentially. Its ratio to the mean of n others exceeds z
    with the probability (1 + z / n)^-n. A median of twice as many orders gives that mean about as well.
    """
    from scipy.ndimage import median_filter  # takes long to load, and most actuators need none

    if highest == 0:
        return 0
    usual = median_filter(power, 2 * NEIGHBOURS + 1, mode="nearest") / math.log(2.0)
    height = power / (usual + 1e-300)
    height[highest:] = 0.0
    height[np.array(taken, dtype=int) - 1] = 0.0
    best = int(np.argmax(height))
    least = NEIGHBOURS * (math.pow(highest / FALSE_ALARM, 1.0 / NEIGHBOURS) - 1.0)
    return best + 1 if height[best] >= least else 0
