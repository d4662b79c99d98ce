"""Which effects, added to an explanation, promise most: read off the balance, then off one simulation each.

The balance screens hundreds of starts of an effect that acts along the motion, and says what share of its error each
takes. A simulation of the best, and of every start of an effect that shows at rests, reversals and stops, is then
compared with the residual of a pulled fit: what share of its error does it take, beside changes of all values that are
free already? Neither share can be held against the other: an error at one moment stays there in the balance, rests show
in a simulation only, and noise fills the balance. So both orders count. Their job is never to lose the truth; fits
decide.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass

import numpy as np

from pierburg_ros.arrays import Flags, Signal
from pierburg_ros.effects import EFFECT, EFFECTS
from pierburg_ros.effects.effect import Start
from pierburg_ros.errors import InputError
from pierburg_ros.inference.balance import Balance
from pierburg_ros.inference.coordinates import Coordinates, in_order
from pierburg_ros.inference.data import Data
from pierburg_ros.inference.evidence import SIGNIFICANT
from pierburg_ros.inference.explanation import Explanation, Variant
from pierburg_ros.inference.fit import Fit, Fitter
from pierburg_ros.inference.intervals import slopes_at
from pierburg_ros.inference.least_squares import FULL, beside, jacobian, minimise
from pierburg_ros.plant import Model

SCREENED = 4
"""Starts of one effect that the balance hands on. Work: each costs two simulations; not varied."""
SETTLING = 8
"""Iterations of such a fit. Work: the simulation fits on."""
EQUAL = 0.01
"""Share by which the numbers of two equal starts differ at most. Chosen: far less than a fit moves them."""
ROUNDS = 3
"""Fits of the balance, each without what was outlying in the one before. Work: each takes milliseconds; not varied."""


@dataclass(frozen=True)
class Promise:
    """A start of an added effect: all values by dotted name, and the shares of the error that it promises to take.

    `simulated` is that of a pulled fit by one linear step, `along` that of the balance, `at_rests` of the torque that
    friction cannot bear at rests. `balanced` are all values by the balance with the effect acting.
    """

    variant: Variant
    values: dict[str, float]
    simulated: float
    along: float
    at_rests: float
    balanced: dict[str, float]

    def equals(self, other: Promise) -> bool:
        """Whether a fit would begin where one of `other` does."""
        return self.variant == other.variant and all(
            math.isclose(mine[name], value, rel_tol=EQUAL)
            for mine, theirs in ((self.values, other.values), (self.balanced, other.balanced))
            for name, value in theirs.items()
        )


@dataclass(frozen=True)
class Span:
    """How far recordings go (`effects.effect.Reach`), in multiples of the actuator's scales."""

    duration: float
    low: float
    high: float


def balanced(
    balance: Balance, nominal: Model, names: Sequence[str], values: Mapping[str, float], effects: Sequence[str] = ()
) -> tuple[dict[str, float], Balance]:
    """Values of the base parameters `names` by the balance beside `effects`, and the balance without outliers."""
    found = {**nominal.values, **values}
    for _ in range(ROUNDS):
        found, left = fitted(balance, nominal, names, found, effects)
        balance = balance.without_outliers(left)
    return found, balance


def fitted(
    balance: Balance,
    nominal: Model,
    names: Sequence[str],
    start: Mapping[str, float],
    effects: Sequence[str],
    iterations: int = FULL,
    which: Flags | None = None,
) -> tuple[dict[str, float], Signal]:
    """Values of `names` by the balance beside `effects` from a `start` on, and what they leave, shape (samples,).

    By some of the samples where flags say `which`.
    """
    coordinates = Coordinates(tuple(names), nominal, balance.duration)

    def values(point: Signal) -> dict[str, float]:
        return in_order({**start, **coordinates.values(point)}, nominal)

    def residual(point: Signal) -> Signal:
        left = balance.residual(values(point), effects)
        return left if which is None else left[which]

    found = values(
        minimise(residual, coordinates.point(start), *coordinates.bounds, coordinates.steps, iterations).point
    )
    return found, balance.residual(found, effects)


def independent(fitter: Fitter, balance: Balance, names: Sequence[str]) -> tuple[str, ...]:
    """Those of the base parameters `names` that the recordings tell from the others, in their order.

    First come those that the balance tells from the ones before them, then what only a simulation shows, as the zero of
    a sensor. Of quantities of which only a ratio shows the last is held: what scales with the others stays as it is.
    What shows nowhere in its range is held too.
    """
    nominal = fitter.nominal
    _, slopes = sloped(balance, nominal, names, nominal.values, ())
    moving = [names[place] for place in telling(slopes)]
    ordered = (*moving, *(name for name in names if name not in moving))
    own = Explanation(ordered)
    lower, upper = fitter.coordinates(own).bounds
    simulated = slopes_at(fitter.fit(Explanation(), nominal.values, 0), own)
    seen = np.linalg.norm(simulated, axis=0) * (upper - lower) > math.sqrt(SIGNIFICANT)
    kept = [ordered[place] for place in telling(simulated) if seen[place]]
    return tuple(name for name in names if name in kept)


def telling(slopes: Signal) -> list[int]:
    """The columns of `slopes`, shape (samples, names), that are no combination of the ones before them."""
    kept: list[int] = []
    for place in range(slopes.shape[1]):
        column = slopes[:, place]
        if kept:
            column = beside(column, np.linalg.qr(slopes[:, kept])[0])
        if np.linalg.norm(column) > DEPENDENT * np.linalg.norm(slopes[:, place]):
            kept.append(place)
    return kept


DEPENDENT = 1e-3
"""Share of a slope that is left beside others below which they hold it. Derived: differences of a thousandth of a
parameter leave half of that of a slope that is a combination of others."""


def forms(data: Data, nominal: Model, span: Span) -> list[tuple[Variant, list[dict[str, float]]]]:
    """Every way in which an effect may act in this actuator, with the values that a search starts from, in units."""
    actuator, found = data.actuator, []
    for effect in EFFECTS:
        if data.obstacle(effect) or effect.id in actuator.effects:
            continue
        for each in effect.variants:
            variant = Variant(effect.id, each.free, tuple(each.fixed.items()))
            units = (effect.in_units(start, nominal.scales) for start in each.over(span))
            found.append((variant, [{**start, **each.fixed} for start in units]))
    return found


@dataclass(frozen=True)
class Reading:
    """A start of an effect as the balance reads it.

    `starts` differ in phase alone. `values` are all values by dotted name of a fit of the balance beside the effect;
    `share` is what it takes of the error that the balance leaves without it, and `at_rests` of that at rests.
    """

    variant: Variant
    starts: list[Start]
    values: dict[str, float]
    share: float
    at_rests: float


def promises(
    fit: Fit,
    balance: Balance,
    candidates: Sequence[tuple[Variant, list[dict[str, float]]]],
    pool: Executor,
) -> list[Promise]:
    """What each of the `candidates` promises on top of a `fit`."""
    _, readings = read(fit, balance, candidates)
    found = pool.map(lambda reading: _promise(fit, reading), readings)
    return [each for each in found if each is not None]


def read(
    fit: Fit, balance: Balance, candidates: Sequence[tuple[Variant, list[dict[str, float]]]]
) -> tuple[Balance, list[Reading]]:
    """The balance without events beside a `fit`, and how it reads the best starts of each of the `candidates`."""
    nominal = fit.fitter.nominal
    base = fit.explanation.drifted
    acting = fit.explanation.effects
    values, inside = balanced(balance, nominal, base, fit.values, acting)
    # a load that lasts is outlying, where it acts
    lasting = balance.without_events(balance.residual(values, acting))
    sides = [(side, *projected(side, nominal, base, values, acting)) for side in (inside, lasting)]
    readings: list[Reading] = []
    for variant, starts in candidates:
        if variant.effect in acting:
            continue
        starts, at_rests = _told_by_rests(balance, values, variant, starts)
        several, declared = _in_quadrature(variant.effect, starts), EFFECT[variant.effect]
        side, project, left = sides[declared.dated]
        if declared.along is not None and declared.mark is None:
            screened = [_screened(side, values, variant, group, project, left) for group in several]
            several = [group for _, group in sorted(screened, key=lambda each: -each[0])[:SCREENED]]
            several = [_dated(side, values, variant, group, project, left) for group in several]
        for group in several:
            begun, settled, rest = _settled(side, nominal, base, acting, values, variant, group)
            share = 1.0 - rest / max(float(left @ left), 1e-300)
            # where the balance takes no more of an effect than chance gives, its numbers are nothing to simulate
            begun = begun if share * left.size > 1.0 else group
            readings.append(Reading(variant, begun, settled, share, at_rests))
    return inside, readings


def _told_by_rests(
    balance: Balance, values: Mapping[str, float], variant: Variant, starts: list[dict[str, float]]
) -> tuple[list[dict[str, float]], float]:
    """Starts with the numbers that rests of the shaft tell, where these make it no weaker, and the share they take."""
    effect = EFFECT[variant.effect]
    if effect.at_rests is None:
        return starts, 0.0
    told, share = effect.at_rests([rest for motion in balance.motions for rest in motion.rests], values)
    if any(value < min(start[name] for start in starts) for name, value in told.items()):
        return starts, 0.0
    return distinct([{**start, **told} for start in starts]), share


def distinct(several: list[dict[str, float]]) -> list[dict[str, float]]:
    """The first of each that are equal."""
    return [each for place, each in enumerate(several) if each not in several[:place]]


def added(values: Mapping[str, float], variant: Variant, start: Start) -> dict[str, float]:
    """`values` of a model with an effect that starts at `start`."""
    effect = EFFECT[variant.effect]
    own = {f"{effect.id}.{name}": start.get(name, 0.0) for name in effect.names}
    return {**values, **effect.counted(own, values)}


def projected(
    balance: Balance, nominal: Model, names: Sequence[str], values: Mapping[str, float], acting: Sequence[str]
) -> tuple[Signal, Signal]:
    """Orthonormal basis of what base parameters change in the balance, and the residual beside it."""
    left, slopes = sloped(balance, nominal, names, values, acting)
    basis = np.linalg.qr(slopes)[0]
    return basis, beside(left, basis)


def sloped(
    balance: Balance, nominal: Model, names: Sequence[str], values: Mapping[str, float], acting: Sequence[str]
) -> tuple[Signal, Signal]:
    """The residual of the balance, shape (samples,), and its derivative by the coordinates of base parameters."""
    coordinates = Coordinates(tuple(names), nominal, balance.duration)
    point = coordinates.point(values)

    def residual(at: Signal) -> Signal:
        return balance.residual(in_order({**values, **coordinates.values(at)}, nominal), acting)

    left = residual(point)
    return left, jacobian(residual, point, left, *coordinates.bounds, coordinates.steps)


def _screened(
    balance: Balance,
    values: Mapping[str, float],
    variant: Variant,
    group: Sequence[Start],
    basis: Signal,
    left: Signal,
) -> tuple[float, list[Start]]:
    """What starts take of the balance's squared error that differ in phase alone, and they with their strength."""
    columns = np.stack([balance.column(added(values, variant, start), variant.effect) for start in group], axis=1)
    columns = beside(columns, basis)
    scale, fall = _step(columns, left, _limits(variant.effect, group))
    # what takes no more than chance gives tells nothing of its strength
    told = fall * left.size > float(left @ left)
    return fall, _scaled(variant.effect, group, scale) if told else list(group)


def _dated(
    balance: Balance,
    values: Mapping[str, float],
    variant: Variant,
    group: list[Start],
    basis: Signal,
    left: Signal,
) -> list[Start]:
    """A start with its moments, if it has any, moved to where it takes most: a balance has no slope over them."""
    moments = [p.name for p in EFFECT[variant.effect].parameters if p.moment and p.name in variant.free]
    step = balance.duration / DATES
    best = _screened(balance, values, variant, group, basis, left)
    while moments and step > 2.0 * balance.motions[0].step:
        step *= 0.5
        for name in moments:
            for by in (-step, step):
                moved = [{**start, name: start[name] + by if start[name] else 0.0} for start in best[1]]
                best = max(best, _screened(balance, values, variant, moved, basis, left), key=lambda each: each[0])
    return best[1]


DATES = 30
"""Parts of a recording between which the moments of starts lie. Given: the starts that effects declare have as many."""


def _settled(
    balance: Balance,
    nominal: Model,
    names: Sequence[str],
    acting: Sequence[str],
    values: Mapping[str, float],
    variant: Variant,
    group: Sequence[Start],
) -> tuple[list[Start], dict[str, float], float]:
    """Starts after a fit of the balance beside the effect, all values of that fit, and the squared error it leaves.

    What shows at rests, reversals or stops keeps its numbers: a balance of motion tells little of them.
    """
    effect = EFFECT[variant.effect]
    own = () if effect.mark else variant.names
    start = in_order(added(values, variant, group[0]), nominal)
    if not own and effect.along is None:
        return list(group), start, math.inf
    settled, left = fitted(balance, nominal, (*names, *own), start, (*acting, variant.effect), SETTLING)
    rest = float(left @ left)
    if not own:
        return list(group), settled, rest
    numbers = {
        p.name: settled[f"{effect.id}.{p.name}"] - (settled[p.above] if p.above else 0.0) for p in effect.parameters
    }
    if len(group) < 2 or effect.ripple is None:
        return [numbers], settled, rest
    turned = {**numbers, effect.ripple.phase: numbers[effect.ripple.phase] + math.pi / 2}
    return [numbers, turned], settled, rest


def _promise(fit: Fit, reading: Reading) -> Promise | None:
    """What one linear step along some starts foretells; None where the effect cannot be added to the fit."""
    fitter, before, columns = fit.fitter, fit.fitted, []
    variant, group = reading.variant, reading.starts
    samples = fitter.data.train
    for start in group:
        try:
            models = fitter.models(fit.explanation, in_order(added(fit.values, variant, start), fitter.nominal))
        except InputError:
            return None
        columns.append(fitter.residual(*models)[samples] - before)
    changed = beside(np.stack(columns, axis=1), fit.basis)
    scale, fall = _step(changed, beside(before, fit.basis), _limits(variant.effect, group))
    start = _scaled(variant.effect, group, scale)[0]
    if EFFECT[variant.effect].mark is not None:
        # where events jump a linear step tells little: what it leaves there is simulated
        fall = max(fall, fit.chi2 - _chi2_at(fit, reading))
    simulated = fall / max(fit.chi2, 1e-300)
    values = in_order(added(fit.values, variant, start), fitter.nominal)
    return Promise(variant, values, simulated, reading.share, reading.at_rests, reading.values)


def _chi2_at(fit: Fit, reading: Reading) -> float:
    """What the values of a reading leave of the samples of a fit; infinite where no model can have them."""
    try:
        left = fit.fitter.fitted(fit.explanation, in_order(reading.values, fit.fitter.nominal))
    except InputError:
        return math.inf
    return float(left @ left)


def _step(columns: Signal, left: Signal, limits: tuple[float, float]) -> tuple[Signal, float]:
    """By how much to scale columns for the least squared error beside what is `left`, and the fall of it.

    A single column is scaled within `limits`: beyond a simulation is not linear.
    """
    normal, slope = columns.T @ columns, columns.T @ left
    if np.linalg.cond(normal) > SINGULAR:
        return np.zeros(slope.size), 0.0
    scale = -np.linalg.solve(normal, slope)
    if scale.size == 1:
        scale = np.clip(scale, *limits)
    return scale, float(-(2.0 * slope + normal @ scale) @ scale)


def _limits(effect: str, group: Sequence[Start]) -> tuple[float, float]:
    """The least and the largest factor by which the strength of a start is scaled; below 0 where it has two signs."""
    strengths = [(each.stride, each.minimum) for each in map(EFFECT[effect].parameter, group[0]) if each.stride]
    most = max((stride for stride, _ in strengths), default=1.0)
    return (-most if any(minimum < 0.0 for _, minimum in strengths) else 0.0), most


SINGULAR = 1e12
"""Condition of normal equations beyond which columns tell nothing. Derived: rounding is then a hundredth of them."""


def _in_quadrature(effect: str, starts: Sequence[Start]) -> list[list[Start]]:
    """Starts in groups that differ only in the phase of a ripple: a linear step finds any phase between them."""
    ripple = EFFECT[effect].ripple
    groups: dict[tuple[tuple[str, float], ...], list[Start]] = {}
    for start in starts:
        key = tuple(sorted((name, value) for name, value in start.items() if not ripple or name != ripple.phase))
        groups.setdefault(key, []).append(start)
    return list(groups.values())


def _scaled(effect: str, group: Sequence[Start], scale: Signal) -> list[Start]:
    """The starts with the strength, and the phase, that a linear step gives them."""
    declared, values = EFFECT[effect], dict(group[0])
    ripple = declared.ripple
    if len(group) == 2 and ripple is not None:
        values[ripple.amplitude] *= float(np.hypot(*scale))
        turned = values[ripple.phase] + float(np.arctan2(scale[1], scale[0]))
        values[ripple.phase] = math.remainder(turned, 2.0 * math.pi)
        return [values, {**values, ripple.phase: values[ripple.phase] + math.pi / 2}]
    for name in values:
        stride = declared.parameter(name).stride
        if stride is not None:
            values[name] *= math.copysign(float(np.clip(abs(scale[0]), 1.0 / stride, stride)), scale[0])
    return [values]
