"""A fit that begins near or far, whose range goes along with it, and the parameters that it drives from every range."""

from __future__ import annotations

from collections.abc import Sequence

from pierburg_ros.estimation.balanced import Motion, balanced
from pierburg_ros.estimation.coordinates import in_order
from pierburg_ros.estimation.data import data_of
from pierburg_ros.estimation.likelihood import EXPLAINED
from pierburg_ros.estimation.run import inputs_of
from pierburg_ros.estimation.turn import with_turn
from pierburg_ros.identification.fit import Identified, fit
from pierburg_ros.plant import Model
from pierburg_ros.recording import Recording

FOLLOWED = 2
"""How often the range of a search, a factor of 6 either way, is moved to where the fit left it. Chosen: a description
that is off by a factor of 200 is better written anew."""


def fitted(
    model: Model, recordings: Sequence[Recording], free: Sequence[str], starts: int = 3, jobs: int | None = None
) -> tuple[Identified, tuple[str, ...]]:
    """`model` fitted to `recordings`, and which of the `free` parameters run away from every range.

    One that the fit does as well without, to a tenth of its error, is held as described. Where a shaft goes round, what
    repeats itself with every turn is part of the model if the error falls by a tenth: else the inertia, which smooths
    the motion, stands for it.
    """
    base, found = begun(model, recordings, free, starts, jobs)
    if repeating := what_repeats(found.model, recordings):
        beside = base.with_residual(repeating.residual_torque)
        again = fit(beside, recordings, free, starts=starts, jobs=jobs)
        if EXPLAINED * again.rmse < found.rmse:
            base, found = beside, again
    found, held = _held(found, base, model, recordings, jobs)
    for _ in range(FOLLOWED):
        if not runaway(found):
            break
        found = fit(found.model, recordings, found.names, starts=1, jobs=jobs)
    return found, (*held, *runaway(found))


def begun(
    model: Model, recordings: Sequence[Recording], free: Sequence[str], starts: int, jobs: int | None
) -> tuple[Model, Identified]:
    """The better of the fits from `model` and, where that leaves more than noise, from the balance of torques.

    Also where it began, from where it goes on with further `starts` while more than noise is left.
    """
    base, found = model, fit(model, recordings, free, starts=1, jobs=jobs)
    motions = [Motion(inputs_of(each), each.time, each.measured, each.quantity) for each in recordings]
    if found.fit.ratio > EXPLAINED and (other := balanced(model, motions, free)) is not None:
        again = fit(other, recordings, free, starts=1, jobs=jobs)
        if again.rmse < found.rmse:
            base, found = other, again
    if found.fit.ratio > EXPLAINED and starts > 1:
        found = fit(base, recordings, free, starts=starts, jobs=jobs)
    return base, found


def _held(
    found: Identified, base: Model, described: Model, recordings: Sequence[Recording], jobs: int | None
) -> tuple[Identified, tuple[str, ...]]:
    """Those that run away held as `described` one after the other, while the error stays, and which these are."""
    best, held = found, tuple[str, ...]()
    while (endless := runaway(best)) and len(best.names) > 1:
        tried = [
            fit(
                base.with_values(in_order({each: described.values[each] for each in (*held, out)}, base)),
                recordings,
                tuple(name for name in best.names if name != out),
                starts=1,
                jobs=jobs,
            )
            for out in endless
        ]
        least = min(range(len(tried)), key=lambda place: tried[place].rmse)
        if tried[least].rmse > EXPLAINED * found.rmse:
            break
        best, held = tried[least], (*held, endless[least])
    return best, held


def what_repeats(fitted: Model, recordings: Sequence[Recording]) -> Model | None:
    """A fitted model with the torque over a turn that it lacks; None where none is seen, or it has one of its own.

    A torque told in the wrong scale repeats itself with the angle too, so the scale is fitted first.
    """
    return None if fitted.residual_torque is not None else with_turn(data_of(recordings, fitted), fitted)


def runaway(found: Identified) -> tuple[str, ...]:
    """The free parameters that end where their search ends."""
    coordinates, point = found.estimator.coordinates(found.fit.explanation), found.fit.solution.point
    ends = zip(found.names, point, *coordinates.bounds, strict=True)
    return tuple(name for name, x, low, high in ends if min(x - low, high - x) <= 1e-6 * (high - low))
