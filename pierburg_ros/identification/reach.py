"""A fit from a near or a far start, whose range moves with it, and the parameters that leave every range."""

from __future__ import annotations

from collections.abc import Sequence

from pierburg_ros.identification.fit import Identified, balanced_starts, fit, fitter_of
from pierburg_ros.identification.turn import with_turn
from pierburg_ros.inference.coordinates import in_order
from pierburg_ros.inference.evidence import EXPLAINED
from pierburg_ros.inference.intervals import ON_BOUND
from pierburg_ros.plant import Model
from pierburg_ros.recording import Recording

FOLLOWED = 2
"""Number of times that the range of a search, a factor of 6 either way, is moved to where the fit left it. Chosen: a
description that is off by a factor of 200 is better written anew."""


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
        if EXPLAINED * again.fit.ratio < found.fit.ratio:
            base, found = beside, again
    found, held = _held(found, base, model, recordings, jobs)
    for _ in range(FOLLOWED):
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
    for _ in range(FOLLOWED):
        for values in balanced_starts(fitter_of(recordings, far), free):
            far = far.with_values({name: values[name] for name in free})
    again = fit(far, recordings, free, jobs)
    return (far, again) if again.fit.ratio < found.fit.ratio else (model, found)


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
        least = min(range(len(tried)), key=lambda place: tried[place].fit.ratio)
        if tried[least].fit.ratio > EXPLAINED * found.fit.ratio:
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
