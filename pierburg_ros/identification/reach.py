"""A fit from a near or a far start, whose range moves with it, and the parameters that leave every range."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.identification.fit import FEWEST_MOMENTS, Identified, fit, fitter_of, own_balance
from pierburg_ros.identification.turn import with_turn
from pierburg_ros.inference.balance import Balance
from pierburg_ros.inference.coordinates import in_order
from pierburg_ros.inference.covariance import RANK
from pierburg_ros.inference.evidence import EXPLAINED
from pierburg_ros.inference.intervals import ON_BOUND
from pierburg_ros.plant import Model
from pierburg_ros.recording import Recording

RANGES_MOVED = 2
"""Number of times that the range of a search, a factor of 6 either way, is moved to where the fit left it. Chosen: a
description that is off by a factor of 200 is better written anew."""

FARTHEST = 200.0
"""Largest factor by which a number may be wrong, either way. Chosen: a description that is off by more is better
written anew."""
DIFFERENCE = 1e-4
"""Share of a value by which it is moved for a slope. Derived: the balance is smooth, and this is far above rounding."""


def fitted(
    model: Model, recordings: Sequence[Recording], free: Sequence[str], jobs: int | None = None
) -> tuple[Identified, tuple[str, ...]]:
    """`model` fitted to `recordings`, and the `free` parameters that run away from every range.

    A parameter without which the fit is as good, to a tenth of its error, is held as described. Where a shaft turns
    round, a torque that repeats with every turn becomes part of the model if the error falls by a tenth. Otherwise the
    fit would use the inertia, which smooths the motion, in place of that torque.
    """
    base, found = begun(model, recordings, free, jobs)
    if repeating := what_repeats(found):
        beside = base.with_residual(repeating.residual_torque)
        again = fit(beside, recordings, free, jobs)
        if EXPLAINED * again.rmse < found.rmse:
            base, found = beside, again
    found, held = _held(found, base, model, recordings, jobs)
    for _ in range(RANGES_MOVED):
        if not runaway(found):
            break
        found = fit(found.model, recordings, found.names, jobs)
    return found, (*held, *runaway(found))


def begun(
    model: Model, recordings: Sequence[Recording], free: Sequence[str], jobs: int | None
) -> tuple[Model, Identified]:
    """The start model and the fit from it: `model`, or where torques balance however far that is.

    The balance is followed where the fit from `model` leaves more than noise.
    """
    found = fit(model, recordings, free, jobs)
    if found.fit.ratio <= EXPLAINED:
        return model, found
    far = model
    for _ in range(RANGES_MOVED):
        far = farther(far, own_balance(fitter_of(recordings, far)), free)
    again = fit(far, recordings, free, jobs)
    return (far, again) if again.rmse < found.rmse else (model, found)


def farther(model: Model, balance: Balance, free: Sequence[str]) -> Model:
    """`model` with the values of `free` at which torques balance by a linear estimate: nearly all enter them linearly.

    A search by ratios, which keeps them positive, would end at its bound where one is wrong by far.
    """
    names = [name for name in free if model.values[name] > 0.0 and model.range(name)[0] >= 0.0]
    if not names or balance.size < FEWEST_MOMENTS * len(names):
        return model
    now, effects = np.array([model.values[name] for name in names]), model.active_effects

    def left(values: Signal) -> Signal:
        return balance.residual(in_order({**model.values, **dict(zip(names, values, strict=True))}, model), effects)

    moves = DIFFERENCE * np.diag(now)
    slopes = np.stack([(left(now + move) - left(now - move)) / (2.0 * DIFFERENCE) for move in moves], axis=1)
    ratio = 1.0 - np.linalg.lstsq(slopes, left(now), rcond=RANK)[0]
    found = now * np.clip(ratio, 1.0 / FARTHEST, FARTHEST)
    ranges = (model.range(name) for name in names)
    bounded = {name: min(max(x, low), high) for name, x, (low, high) in zip(names, found.tolist(), ranges, strict=True)}
    return model.with_values(in_order(bounded, model))


def _held(
    found: Identified, base: Model, described: Model, recordings: Sequence[Recording], jobs: int | None
) -> tuple[Identified, tuple[str, ...]]:
    """The fit with runaway parameters held as `described` one by one, as long as the error stays, and their names."""
    best, held = found, tuple[str, ...]()
    while (endless := runaway(best)) and len(best.names) > 1:
        tried = [
            fit(
                base.with_values(in_order({each: described.values[each] for each in (*held, out)}, base)),
                recordings,
                tuple(name for name in best.names if name != out),
                jobs,
            )
            for out in endless
        ]
        least = min(range(len(tried)), key=lambda place: tried[place].rmse)
        if tried[least].rmse > EXPLAINED * found.rmse:
            break
        best, held = tried[least], (*held, endless[least])
    return best, held


def what_repeats(found: Identified) -> Model | None:
    """A fitted model with the torque over a turn that it lacks; None where none is detected, or it has one of its own.

    A torque in the wrong scale repeats with the angle too, so the scale is fitted first.
    """
    model = found.model
    return None if model.residual_torque is not None else with_turn(found.fitter.data, model)


def runaway(found: Identified) -> tuple[str, ...]:
    """The free parameters that end at a bound of their search."""
    coordinates, point = found.fitter.coordinates(found.fit.explanation), found.fit.solution.point
    ends = zip(found.names, point, *coordinates.bounds, strict=True)
    return tuple(name for name, x, low, high in ends if min(x - low, high - x) <= ON_BOUND * (high - low))
