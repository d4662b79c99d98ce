"""What one linear step from a fit promises: for an added effect, a drift, or a change in mid-recording."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.effects import EFFECT
from pierburg_ros.effects.effect import Start
from pierburg_ros.errors import InputError
from pierburg_ros.estimation.estimator import Estimator, Fit
from pierburg_ros.estimation.run import Switch
from pierburg_ros.inference.explanation import AFTER, WHEN, Explanation, Variant
from pierburg_ros.inference.least_squares import TOLERANCE
from pierburg_ros.plant import Model

REDATED = np.arange(-42.0, 43.0, 2.625)
"""Offsets from the first estimate of the time of a change at which that time is searched again, in the actuator's own
time. Work: 33 simulations; for the valve they are a quarter of a second apart, which a descent bridges."""
LEVEL = 1e-6
"""Relative difference in cost within which two times of a change lie on one step of the cost. Derived: a time that does
not matter changes the cost by rounding alone, below 1e-12."""


def promised(
    estimator: Estimator, base: Fit, variant: Variant, starts: Sequence[Start]
) -> list[tuple[float, dict[str, float]]]:
    """Pairs of promised chi2 and start, for a linear step from `base` along each of the `starts`, best first.

    Each start is simulated once on top of `base`. The changes that a re-fit of `base` can make are projected out. Two
    starts that differ only in phase count as one with a free phase.
    """
    projected = projection(base)
    residual = projected(base.solution.residual)
    found = []
    for group in _in_quadrature(starts, variant):
        columns, used = [], []
        for start in group:
            changed = difference(estimator, base, variant, start)
            if changed is not None:
                columns.append(changed)
                used.append(start)
        if not columns:
            continue
        change = projected(np.stack(columns, axis=1))
        scale = np.asarray(np.linalg.lstsq(change, residual, rcond=None)[0], dtype=np.float64)
        left = residual - change @ scale
        found.append((float(left @ left), _scaled(base.model, variant, used, scale)))
    return sorted(found, key=lambda pair: pair[0])


def promised_left(fit: Fit) -> float:
    """The chi2 that one linear step from `fit` promises."""
    left = projection(fit)(fit.solution.residual)
    return float(left @ left)


def largest_mark(estimator: Estimator, base: Fit, variant: Variant, starts: Sequence[Start]) -> float:
    """The largest sum of squares [noise^2] that a start leaves in the signal after a linear re-fit of `base`."""
    projected = projection(base)
    changes = (difference(estimator, base, variant, start) for start in starts)
    marks = (projected(change) for change in changes if change is not None)
    return max((float(mark @ mark) for mark in marks), default=0.0)


def change_starts(estimator: Estimator, base: Fit, name: str, most: int) -> list[tuple[float, dict[str, float]]]:
    """Up to `most` starts for a change of parameter `name`, by the chi2 that a linear step promises, best first.

    A start holds the values before and after the change, and its time [s].
    """
    run = estimator.data.runs[0]
    time = run.time[run.train]
    probe = estimator.at(Explanation((*base.explanation.drifted, name), base.explanation.variants), base.values)
    slope = probe.solution.jacobian[: time.size, len(base.explanation.drifted)]
    residual = base.solution.residual[: time.size]
    before, weight = np.cumsum(slope * residual), np.cumsum(slope * slope) + 1e-9
    after, rest = before[-1] - before, weight[-1] - weight + 1e-9
    gain = before**2 / weight + after**2 / rest
    starts: list[tuple[float, dict[str, float]]] = []
    for index in np.argsort(gain)[::-1]:
        if all(abs(time[index] - start[name + WHEN]) > 0.05 * time[-1] for _, start in starts):
            shift = np.clip([-before[index] / weight[index], -after[index] / rest[index]], -0.5, 0.5)
            nominal = base.values[name]
            starts.append((base.chi2 - float(gain[index]), {
                **base.values, name: nominal * float(np.exp(shift[0])),
                name + AFTER: nominal * float(np.exp(shift[1])), name + WHEN: float(time[index]),
            }))  # fmt: skip
        if len(starts) == most:
            break
    return starts


def redated(estimator: Estimator, fit: Fit) -> Fit:
    """`fit`, or a better one with a nearby time of its change: the cost has many local minima there.

    While the shaft rests, the time of a change hardly matters, so the cost has steps. A step may become lower than its
    neighbour only after the other values are fitted on it. So the next steps on both sides are tried, as long as the
    gain is large enough for a descent to go on.
    """
    best = estimator.fit(fit.explanation, min(_moments(estimator, fit), key=lambda moment: moment[0])[1])
    best = min(fit, best, key=lambda found: found.chi2)
    while (moved := _on_next_steps(estimator, best)).chi2 < (1.0 - TOLERANCE) * best.chi2:
        best = moved
    return best


def _on_next_steps(estimator: Estimator, fit: Fit) -> Fit:
    """The best of `fit` and the fits on the next steps of the cost before and after the time of its change.

    A step may be narrow: it is entered where the step of `fit` ends.
    """
    moments = _moments(estimator, fit)
    middle = REDATED.size // 2
    beside = (_beside(estimator, fit, side) for side in (moments[:middle][::-1], moments[middle + 1 :]))
    fits = [estimator.fit(fit.explanation, values) for values in beside if values is not None]
    return min([fit, *fits], key=lambda found: found.chi2)


def _beside(estimator: Estimator, fit: Fit, side: list[tuple[float, dict[str, float]]]) -> dict[str, float] | None:
    """The values of `fit` with the first time off its step on one `side`, to within a sample; None if there is none."""
    name, run, inside = f"{fit.explanation.changed}{WHEN}", estimator.data.runs[0], fit.values
    for chi2, outside in side:
        if not _on_step(chi2, fit):
            break
        inside = outside
    else:
        return None
    while abs(outside[name] - inside[name]) > run.time[1] - run.time[0]:
        between = {**fit.values, name: 0.5 * (outside[name] + inside[name])}
        if _on_step(estimator.chi2_at(fit.explanation, between), fit):
            inside = between
        else:
            outside = between
    return outside


def _on_step(chi2: float, fit: Fit) -> bool:
    return abs(chi2 - fit.chi2) <= LEVEL * fit.chi2


def _moments(estimator: Estimator, fit: Fit) -> list[tuple[float, dict[str, float]]]:
    """Pairs of cost and values of `fit`, for each of the times around that of its change."""
    name = f"{fit.explanation.changed}{WHEN}"
    coordinates, shifts = estimator.coordinates(fit.explanation), REDATED * estimator.data.scales.time
    moved = [coordinates.within({**fit.values, name: fit.values[name] + shift}) for shift in shifts]
    return [(estimator.chi2_at(fit.explanation, values), values) for values in moved]


def difference(estimator: Estimator, base: Fit, variant: Variant, start: Start) -> Signal | None:
    """What an effect added to `base` changes in its residual [noise], of the same shape; None if it cannot be added."""
    try:
        added = estimator.residual(*_added(base, variant, start))
    except InputError:
        return None
    # the prior of the values of `base` follows the samples, and does not change
    before = base.solution.residual
    return np.pad(before[: added.size] - added, (0, before.size - added.size))


def _added(base: Fit, variant: Variant, start: Start) -> tuple[Model, Switch | None]:
    """The model of `base` with an effect added, and its switch with the effect added, if any."""
    own = {f"{variant.effect}.{name}": value for name, value in (*start.items(), *variant.fixed)}

    def with_effect(model: Model) -> Model:
        return model.with_values(EFFECT[variant.effect].counted(own, model.values))

    switch = base.switch and Switch(with_effect(base.switch.model), base.switch.time)
    return with_effect(base.model), switch


def projection(fit: Fit) -> Callable[[Signal], Signal]:
    """Projection of residuals, shape (samples,) or (samples, some), onto what re-fitting `fit` cannot change."""
    basis = fit.solution.basis
    return lambda residual: residual - basis @ (basis.T @ residual)


def _in_quadrature(starts: Sequence[Start], variant: Variant) -> list[list[Start]]:
    """Starts in groups that differ only in the phase of a ripple."""
    ripple = EFFECT[variant.effect].ripple
    phase = ripple.phase if ripple else None
    groups: dict[tuple[tuple[str, float], ...], list[Start]] = {}
    for start in starts:
        key = tuple(sorted((name, value) for name, value in start.items() if name != phase))
        groups.setdefault(key, []).append(start)
    return list(groups.values())


def _scaled(model: Model, variant: Variant, used: Sequence[Start], scale: Signal) -> dict[str, float]:
    """The start with the strength that the linear step gives, and with the phase if two starts are in quadrature."""
    effect = EFFECT[variant.effect]
    values = dict(used[0])
    if len(used) == 2 and effect.ripple is not None:
        values[effect.ripple.amplitude] *= float(np.hypot(*scale))
        values[effect.ripple.phase] = float(np.arctan2(scale[1], scale[0]))
    else:
        for name in values:
            stride = effect.parameter(name).stride
            if stride is not None:
                values[name] *= float(np.clip(scale[0], 1.0 / stride, stride))
    own = {f"{variant.effect}.{name}": value for name, value in values.items()}
    return {**model.values, **effect.counted(own, model.values)}
