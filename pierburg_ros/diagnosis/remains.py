"""What the model still lacks: the residual of the balance over angle, velocity, load and time, and as a map."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from pierburg_ros.actuators import units
from pierburg_ros.actuators.wording import torque_word
from pierburg_ros.arrays import Signal
from pierburg_ros.diagnosis.schema import Direction, Over, RemainingShape, ResidualTorque, TorqueOverTime
from pierburg_ros.effects import EFFECT
from pierburg_ros.inference.balance import Balance, missing
from pierburg_ros.inference.fit import Fit
from pierburg_ros.inference.least_squares import beside
from pierburg_ros.inference.motion import Motion
from pierburg_ros.inference.shortlist import DEPENDENT, balanced, projected
from pierburg_ros.pages.numbers import percent
from pierburg_ros.plant import Model

MOST_SHAPES = 3
"""Shapes that are told. Chosen: more do not help a reader."""
WORTH_TELLING = 0.05
"""Share of the missing torque, mean square, from which a shape is told. Chosen: a twentieth; not varied."""
ONE_WAY = 0.8
"""Share of what a shape takes in one direction of the shaft from which it counts as that direction's. Chosen: four
times as much as in the other."""
MAP_NODES = 5
"""Nodes of the map over angle and over velocity. Chosen: a parabola and what bends once more; not varied."""
SAMPLES_OF_NODE = 30
"""Samples of the balance that a node of the map needs. Derived: their mean is known to a fifth of their spread."""
STRETCHES = 60
"""Stretches of a recording in which the missing torque is averaged over time. Chosen: ten pixels each on a page."""


@dataclass(frozen=True)
class Lacking:
    """The load torque [N.m] that a model lacks along all motions, positive closes, each shape (samples,).

    `torque` is with the parameters that the balance would have, `own` with those of the fit; angle [rad], 0 where
    only a speed is measured, velocity [rad/s] and time [s] are beside it, and as `load` [N.m] what the model itself
    asks of the motor, without the missing torque. Columns of `basis` are what parameters could make of it. `turns`: the
    shaft goes round.
    """

    torque: Signal
    own: Signal
    angle: Signal
    velocity: Signal
    time: Signal
    load: Signal
    basis: Signal
    turns: bool

    @property
    def alone(self) -> Signal:
        """What changes of the parameters cannot make of the missing torque."""
        return beside(self.torque, self.basis)


def lacking(fit: Fit, balance: Balance) -> Lacking:
    """The torque that a `fit` lacks, its parameters as the balance would have them beside its effects."""
    nominal, actuator, acting = fit.fitter.nominal, fit.fitter.data.actuator, fit.explanation.effects
    # what shows at rests, reversals or stops keeps its numbers: a balance of motion tells little of them
    along = [each for each in fit.explanation.variants if EFFECT[each.effect].along and not EFFECT[each.effect].mark]
    names = (*fit.explanation.drifted, *(name for each in along for name in each.names))
    values, inside = balanced(balance, nominal, names, fit.values, acting)
    basis, _ = projected(inside, nominal, names, values, acting)
    scale = np.concatenate([motion.driven(values, np.ones(motion.samples.size)) for motion in inside.motions])

    def joined(part: Callable[[Motion], Signal]) -> Signal:
        return np.concatenate([part(motion) for motion in inside.motions])

    torque = joined(lambda motion: missing(motion, values, acting))
    # a basis of commands is one of torques where the torque of a command is the same everywhere
    basis = np.linalg.qr(basis * scale[:, np.newaxis])[0] if basis.size else basis
    return Lacking(
        torque=torque,
        own=joined(lambda motion: missing(motion, fit.values, acting)),
        angle=joined(lambda motion: motion.angle if actuator.quantity != "speed" else np.zeros(motion.samples.size)),
        velocity=joined(lambda motion: motion.velocity),
        time=joined(lambda motion: motion.time),
        load=joined(lambda motion: motion.motor_torque(values)) - torque,
        basis=basis,
        turns=actuator.motion == "rotary" and not actuator.has_stops,
    )


Columns = Sequence[Signal]
FORMS: Mapping[tuple[Over, str], Callable[[Lacking], Columns]] = {
    ("constant", "constant"): lambda at: [np.ones(at.torque.size)],
    ("velocity", "direction"): lambda at: [np.sign(at.velocity)],
    ("velocity", "linear"): lambda at: [at.velocity],
    ("velocity", "square"): lambda at: [at.velocity * np.abs(at.velocity)],
    ("velocity", "cube"): lambda at: [at.velocity**3],
    ("angle", "linear"): lambda at: [at.angle],
    ("angle", "square"): lambda at: [at.angle**2],
    ("angle", "once_a_turn"): lambda at: [np.sin(at.angle), np.cos(at.angle)] if at.turns else [],
    ("angle", "twice_a_turn"): lambda at: [np.sin(2.0 * at.angle), np.cos(2.0 * at.angle)] if at.turns else [],
    ("load", "linear"): lambda at: [np.abs(at.load) * np.sign(at.velocity)],
    ("time", "linear"): lambda at: [at.time],
}
"""What a missing torque may go with: columns over the samples by what they are over and by their form."""


def shapes(at: Lacking) -> list[RemainingShape]:
    """The forms that take most of the missing torque, one after the other, each beside those before it."""
    left, taken, found = at.alone, at.basis, []
    whole = float(left @ left)
    if left.size == 0 or whole <= 0.0:
        return []
    for _ in range(MOST_SHAPES):
        best, share, pair = None, WORTH_TELLING, next(iter(FORMS))
        for form, columns in FORMS.items():
            basis = _beside(columns(at), taken)
            if basis.size and (part := float(np.sum(np.square(basis.T @ left))) / whole) > share:
                best, share, pair = basis, part, form
        if best is None:
            break
        made = best @ (best.T @ left)
        found.append(RemainingShape(over=pair[0], form=pair[1], direction=_way(made, left, at.velocity), share=share))
        left, taken = left - made, np.concatenate([taken, best], axis=1)
    return found


def _beside(columns: Columns, taken: Signal) -> Signal:
    """An orthonormal basis of some columns beside what is `taken`; empty where they add nothing to it."""
    if not columns:
        return np.empty((0, 0))
    own = np.stack(columns, axis=1)
    size = np.linalg.norm(own, axis=0)
    rest = beside(own, taken)
    if np.any(np.linalg.norm(rest, axis=0) <= DEPENDENT * size):
        return np.empty((0, 0))
    return np.asarray(np.linalg.qr(rest)[0])


def _way(made: Signal, left: Signal, velocity: Signal) -> Direction:
    """In which direction of the shaft a shape takes nearly all that it takes."""
    fall = np.square(left) - np.square(left - made)
    ways = [float(np.sum(fall[sign * velocity > 0.0])) for sign in (1.0, -1.0)]
    if ways[0] > ONE_WAY * sum(ways):
        return "positive"
    return "negative" if ways[1] > ONE_WAY * sum(ways) else "both"


FORM = {
    ("constant", "constant"): "is constant",
    ("velocity", "direction"): "changes sign with the direction",
    ("velocity", "linear"): "grows with the speed",
    ("velocity", "square"): "grows with the square of the speed",
    ("velocity", "cube"): "grows with the cube of the speed",
    ("angle", "linear"): "grows with the angle",
    ("angle", "square"): "bends over the angle",
    ("angle", "once_a_turn"): "comes once a turn",
    ("angle", "twice_a_turn"): "comes twice a turn",
    ("load", "linear"): "grows with the load",
    ("time", "linear"): "grows with time",
}
"""Each form in words."""
WAYS = {"both": "", "positive": ", when the angle grows", "negative": ", when the angle falls"}
"""Directions in words."""


def in_words(found: Sequence[RemainingShape], at: Lacking, motion: units.Motion) -> str:
    """The size of the missing torque, or force, and what it goes with."""
    word = torque_word(motion)
    if at.torque.size == 0:
        return f"not known: between stops and pauses the shaft hardly moves, so its motion tells no missing {word}"
    size = float(np.sqrt(np.mean(np.square(at.alone))))
    listed = "; ".join(
        f"{percent(each.share)} of it {FORM[each.over, each.form]}{WAYS[each.direction]}" for each in found
    )
    told = listed or "it goes with neither angle, velocity, load nor time"
    return f"a {word} of {size:.2g} {units.unit_of('N.m', motion)} (root mean square) while the shaft moves: {told}"


def torque_map(at: Lacking) -> dict[str, Signal] | None:
    """The missing torque over angle and velocity, between nodes; None where too little moves."""
    if at.torque.size < SAMPLES_OF_NODE * MAP_NODES:
        return None
    still = float(np.ptp(at.angle)) < 1e-9
    angle = np.zeros(1) if still else _nodes(at.angle)
    velocity = _nodes(at.velocity)
    if velocity[-1] - velocity[0] <= 0.0 or (angle.size > 1 and angle[-1] <= angle[0]):
        return None
    weights = _hats(at.angle, angle)[:, :, np.newaxis] * _hats(at.velocity, velocity)[:, np.newaxis, :]
    columns = weights.reshape(at.own.size, -1)
    # nodes that few samples reach stay at the mean of their neighbours: each pair of neighbours counts as a sample
    ties = _neighbours(angle.size, velocity.size) * math.sqrt(SAMPLES_OF_NODE)
    system = np.concatenate([columns, ties])
    wanted = np.concatenate([at.own, np.zeros(ties.shape[0])])
    torque = np.linalg.lstsq(system, wanted, rcond=None)[0].reshape(angle.size, velocity.size)
    return {"angle": angle, "velocity": velocity, "torque": torque}


def _nodes(values: Signal) -> Signal:
    """Nodes over nearly all of some values, evenly spaced."""
    low, high = (float(end) for end in np.quantile(values, [0.02, 0.98]))
    return np.linspace(low, high, MAP_NODES)


def _hats(values: Signal, nodes: Signal) -> Signal:
    """Weight of each node for each value, linear between nodes and held at the ends, shape (values, nodes)."""
    if nodes.size == 1:
        return np.ones((values.size, 1))
    return np.stack([np.interp(values, nodes, row) for row in np.eye(nodes.size)], axis=1)


def _neighbours(rows: int, columns: int) -> Signal:
    """Differences between neighbouring nodes, shape (pairs, nodes)."""
    place = np.arange(rows * columns).reshape(rows, columns)
    pairs = [*zip(place[1:].ravel(), place[:-1].ravel(), strict=True)]
    pairs += [*zip(place[:, 1:].ravel(), place[:, :-1].ravel(), strict=True)]
    found = np.zeros((len(pairs), place.size))
    for row, (one, other) in enumerate(pairs):
        found[row, [one, other]] = 1.0, -1.0
    return found


def shaped(fit: Fit, at: Lacking) -> Fit | None:
    """The fit with the missing torque added as a map to its model; None where there is no map."""
    grid = torque_map(at)
    if grid is None:
        return None
    model = fit.model.with_residual(grid)
    after = fit.after and fit.after.with_residual(grid)
    return replace(fit, model=model, after=after, residual=fit.fitter.residual(model, after, fit.when))


def document(model: Model, at: Lacking, words: str) -> ResidualTorque | None:
    """The map of the written model, and the missing torque over time."""
    if model.residual_torque is None:
        return None
    grid = {key: np.asarray(values).tolist() for key, values in model.residual_torque.items()}
    edges = np.linspace(0.0, float(at.time.max()) + 1e-9, STRETCHES + 1)
    place = np.searchsorted(edges, at.time, side="right") - 1
    count = np.bincount(place, minlength=STRETCHES)
    mean = np.bincount(place, at.torque, STRETCHES) / np.where(count > 0, count, np.nan)
    over_time = TorqueOverTime(time=(0.5 * (edges[1:] + edges[:-1])).tolist(), torque=mean.tolist())
    return ResidualTorque(**grid, shape=words, over_time=over_time)
