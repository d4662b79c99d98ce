"""The torque that no catalogue effect explains: a shape over angle and velocity, fitted to the measured signal."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass

import numpy as np

from pierburg_ros.actuators.units import Motion, unit_of
from pierburg_ros.actuators.wording import place
from pierburg_ros.arrays import Signal
from pierburg_ros.diagnosis.evidence.missing_torque import MOVING, missing_torque
from pierburg_ros.diagnosis.evidence.motion import motion_of
from pierburg_ros.diagnosis.evidence.stretches import forgotten, in_stretches
from pierburg_ros.estimation.data import Data, held_back, rms
from pierburg_ros.estimation.turn import described_turn, with_turn
from pierburg_ros.inference.coordinates import WIDTH
from pierburg_ros.inference.least_squares import BRIEF, Map, minimise
from pierburg_ros.plant import Model

ANGLES = 7
"""Number of nodes over the angle. Chosen: one for every 15 degrees of the valve; not varied."""
SPREAD = 0.019
"""Prior standard deviation of a node, as a share of the stall torque: it keeps unvisited nodes small. Chosen: a quarter
of the sliding friction of the valve; not varied."""
STEEPNESS = 0.0075
"""Prior standard deviation of the difference of neighbouring nodes, as a share of the stall torque: it keeps the shape
smooth. Chosen: a tenth of the sliding friction of the valve; not varied."""
APART = 0.02
"""Smallest distance of neighbouring nodes of the angle, as a share of the travel. Chosen: an eighth of their distance
where the travel is visited evenly; not varied."""
WEIGHT = 5.0
"""Factor on the prior, since successive residuals are correlated. Derived: the root of 25 samples that count as one."""
STRETCH = 10.5
"""Length of the stretches, each simulated from the measured state, in the actuator's own time. Chosen: 1 s for the
valve, after which a slip at the wrong moment is forgotten; not varied."""
STRETCHES = 24
"""Number of stretches of time over which the missing torque is averaged. Chosen: it makes a plot and decides no
verdict."""


Way = Callable[[Data], Model]
"""A way to calibrate the model below the shape to the training samples."""


@dataclass(frozen=True)
class Shape:
    """A model with its residual torque, and its gain on samples that did not train it.

    `base` is the model without it. `before` and `after` are the RMSE of the base and of the shaped model over whole
    runs on the validation samples, measured unit. `over_time` holds the middle [s] of each stretch of the first
    recording, and the mean torque [N.m] that the base lacks there; nan at rest.
    """

    model: Model
    base: Model
    before: float
    after: float
    words: str
    over_time: tuple[Signal, Signal]


def fit_shape(
    data: Data, ways: Sequence[Way], pool: Executor, progress: Callable[[str], None] = lambda _: None
) -> Shape:
    """The residual torque over angle and velocity that makes a simulation fit the training samples.

    Several `ways` may calibrate the model below it. The search takes the one with the lowest error, with or without a
    shape, on training blocks held back from it. Parameters fitted to whole runs without the missing physics may be
    wrong: they may fit a few standstills that this physics has displaced.
    """
    way = ways[0]
    if len(ways) > 1:
        progress("ways to calibrate the model below a residual torque")
        errors = list(pool.map(lambda way: _left_out(data, way), ways))
        way = ways[int(np.argmin(errors))]
    progress("residual torque over angle and velocity")
    base = way(data).with_residual(None)
    model = _fitted(data, base, pool.map)
    grid = model.residual_torque or {}
    over_time = _over_time(data, base)
    motion = data.actuator.motion
    if "period" in grid:
        shape = described_turn(grid["torque"], unit_of("N.m", motion))
    else:
        shape = described(grid["angle"], grid["velocity"], grid["torque"], motion)
    words = f"{shape}; {described_over_time(*over_time, unit_of('N.m', motion))}."
    before, after = (rms(data.residual(m)[data.validation]) * data.noise for m in (base, model))
    return Shape(model, base, before, after, words, over_time)


def _left_out(data: Data, way: Way) -> float:
    """Error on training blocks held back: that of the model that `way` calibrates or of its shaped one, the lower.

    It is the product of the RMSE over whole runs and the RMSE over stretches. In whole runs a few standstills at the
    wrong angle can decide. Stretches do not show what a model forgets slowly.
    """
    inner = held_back(data)
    length = STRETCH * data.scales.time
    stretches, trained = in_stretches(data, length), in_stretches(inner, length).train
    base = way(inner)

    def error(model: Model) -> float:
        whole = data.residual(model)[data.train & ~inner.train]
        short = stretches.residual(model)[stretches.train & ~trained]
        return math.prod(rms(residual) for residual in (whole, short))

    return min(error(base), error(_fitted(inner, base)))


def _fitted(data: Data, base: Model, over: Map = map) -> Model:
    """`base` with its best shape; `over` maps a function over the columns of a Jacobian.

    The shape is bilinear between about 7 x 6 nodes. The signal is simulated in short stretches, each from the measured
    state: a slip at the wrong moment is forgotten after one. Large errors count by their logarithm. A prior keeps the
    shape small and smooth. For a shaft that goes round, the shape is over a turn and read from the balance of torques.
    """
    if (turning := with_turn(data, base.with_residual(None))) is not None:
        return turning
    own = data.scales.torque
    stretches = in_stretches(data, STRETCH * data.scales.time) if forgotten(base.active_effects) else data
    training = stretches.train
    angle, velocity = nodes(data)
    prior = WEIGHT * _prior(angle.size, velocity.size)

    def shaped(point: Signal) -> Model:
        torque = own * point.reshape(angle.size, velocity.size)
        return base.with_residual({"angle": angle, "velocity": velocity, "torque": torque})

    def error(candidate: Model) -> Signal:
        return stretches.residual(candidate)[training]

    scale = rms(error(base))

    def residual(point: Signal) -> Signal:
        misfit = error(shaped(point)) / scale
        return np.concatenate([np.sign(misfit) * np.log1p(np.abs(misfit)), prior @ point])

    size = angle.size * velocity.size
    bound, step = np.full(size, WIDTH * SPREAD), np.full(size, STEEPNESS / 10.0)
    solution = minimise(residual, np.zeros(size), -bound, bound, step, BRIEF // 2, 3e-3, over)
    return shaped(solution.point)


def nodes(data: Data) -> tuple[Signal, Signal]:
    """Nodes of angle [rad] and velocity [rad/s], placed by how often the data visit them.

    The innermost nodes of velocity are where friction has a known sign: friction changes between them.
    """
    motions = [motion_of(run, data.actuator, data.noise) for run in data.runs]
    # with a coarse converter, no sample may be known to move
    known = any(motion.moving.any() for motion in motions)
    angles = np.concatenate([motion.angle[motion.moving] if known else motion.angle for motion in motions])
    speeds = np.concatenate([motion.velocity[motion.moving] for motion in motions])
    own = data.scales
    slow = MOVING * own.angle / own.time
    angle = _apart(np.quantile(angles, np.linspace(0.01, 0.99, ANGLES)), APART * own.angle)
    sides = []
    for side in (speeds[speeds > slow], -speeds[speeds < -slow]):
        outer = np.quantile(side, (0.5, 0.95)) if side.size else np.empty(0)
        sides.append(_apart(np.concatenate([[slow], outer]), 0.5 * slow))
    return angle, np.concatenate([-sides[1][::-1], sides[0]])


def _apart(values: Signal, least: float) -> Signal:
    """Increasing `values` without those closer than `least` to the last one kept."""
    kept = [float(values[0])]
    for value in values[1:]:
        if value - kept[-1] >= least:
            kept.append(float(value))
    return np.array(kept)


def _prior(angles: int, velocities: int) -> Signal:
    """Rows whose product with the nodes is a residual in standard deviations: each node, and neighbours' differences.

    Nodes on either side of velocity 0 are not coupled: friction may differ between directions.
    """
    size = angles * velocities
    number = np.arange(size).reshape(angles, velocities)
    middle = velocities // 2
    along = np.stack([number[:-1].ravel(), number[1:].ravel()], axis=1)
    across = [number[:, [j, j + 1]] for j in range(velocities - 1) if j + 1 != middle]
    pairs = np.concatenate([along, *across])
    differences = np.zeros((pairs.shape[0], size))
    rows = np.arange(pairs.shape[0])
    differences[rows, pairs[:, 0]], differences[rows, pairs[:, 1]] = -1.0, 1.0
    return np.concatenate([np.eye(size) / SPREAD, differences / STEEPNESS])


def _over_time(data: Data, model: Model) -> tuple[Signal, Signal]:
    """Middle [s] of each stretch of the longest run, and the mean torque missing there [N.m]; nan where at rest."""
    run = data.longest
    missing, own = missing_torque(data, run, model), data.scales
    edges = np.linspace(run.time[0], run.time[-1], STRETCHES + 1)
    place = np.clip(np.searchsorted(edges, own.time * missing.time, side="right") - 1, 0, STRETCHES - 1)
    count = np.bincount(place, minlength=STRETCHES)
    total = np.bincount(place, weights=own.torque * missing.torque, minlength=STRETCHES)
    mean = np.divide(total, count, out=np.full(STRETCHES, math.nan), where=count >= 5)
    return (edges[:-1] + edges[1:]) / 2 - run.time[0], mean


def described(angle: Signal, velocity: Signal, torque: Signal, motion: Motion = "rotary") -> str:
    """The shape in words: where it is strongest in either direction, and how it depends on angle and direction."""
    parts = []
    unit, speed, way = (unit_of(declared, motion) for declared in ("N.m", "rad/s", "rad"))
    for sign, verb in ((1.0, "closes"), (-1.0, "opens")):
        row, column = np.unravel_index(int(np.argmax(sign * torque)), torque.shape)
        if sign * torque[row, column] > 0.0:
            parts.append(
                f"{abs(torque[row, column]):#.2g} {unit} that {verb} at {place(angle[row], angle[row], motion)} and"
                f" {velocity[column]:.2g} {speed}"
            )
    opening, closing = (float(torque[:, side].mean()) for side in (velocity > 0.0, velocity < 0.0))
    drag = (opening - closing) / 2.0
    resists = "resists" if drag >= 0.0 else "drives"
    slope = float(np.polyfit(angle, torque.mean(axis=1), 1)[0]) if angle.size > 1 else 0.0
    return (
        f"up to {' and '.join(parts) or 'nothing'}; on average {abs(drag):#.2g} {unit} that {resists} the movement,"
        f" and {slope:+#.2g} {unit} per {way} of opening"
    )


def described_over_time(time: Signal, torque: Signal, unit: str = "N.m") -> str:
    """How the missing torque changes over the recording, in words."""
    known = np.isfinite(torque)
    if np.count_nonzero(known) < 4:
        return "too little movement to say how it goes over time"
    slope, offset = np.polyfit(time[known], torque[known], 1)
    left = torque[known] - slope * time[known] - offset
    rise, scatter = float(slope * (time[-1] - time[0])), float(np.std(left))
    if abs(rise) > 2.0 * scatter:
        return f"over the recording it {'grows' if rise > 0.0 else 'falls'} by {abs(rise):#.2g} {unit}"
    return f"over the recording it varies by {scatter:#.2g} {unit} without a trend"
