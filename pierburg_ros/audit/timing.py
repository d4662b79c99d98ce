"""Causality: a shaft may answer its input late, for delays and lags exist, but never before, and always alike."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.audit.explained import BESIDE, Explained, Fit, correlated, explained
from pierburg_ros.audit.fault import Fault
from pierburg_ros.audit.signals import Signals
from pierburg_ros.plant import Model

FARTHEST = 0.02
"""Largest difference of two clocks that is looked for, as a share. Chosen: a quartz is off by 0.01 %, a busy simulator
by percents; not varied."""
SHARPER = 10
"""Samples over which a velocity is told whose changes are compared. Chosen: 20 ms at 500 Hz; half of it drowns in
noise."""
EARLY = 2.5
"""Samples by which measured changes of velocity must come before the simulated ones. Derived: an input recorded one
sample late, as one sample may be, and the rounding of the lag."""
PLAINLY = 0.9
"""Share of the best agreement that is left without a shift, or with the same one in all parts, at most. Measured: clean
recordings keep 0.97 or more where their best lag is early (n = 30), and 0.99 or more with one lag for all parts (n = 9,
four with an effect put in); with a clock 0.2 to 1 % off they keep 0.26 to 0.87 (n = 16)."""
SEEN = 0.4
"""Correlation of changes of velocity from which a lag is seen. Measured: with less the best lag lies anywhere in clean
recordings (n = 52)."""
SELDOM = 5.0
"""Sample intervals between two inputs from which the input is recorded too seldom. Chosen: a controller that runs at a
fifth of the sensor's rate is rare, and one that is early besides is not run at that rate."""

PARTS = 6
"""Parts of a recording in which the lag is told by itself. Chosen: each of a minute's has ten seconds; not varied."""
TOLD = 4
"""Parts whose lag must be seen for a drift to be told. Derived: two always lie on a line, and three that friction
displaced may."""
DRIFTS = 10.0
"""Samples by which the lag must drift from end to end. Chosen: 20 ms at 500 Hz; less is a small delay at either end."""
UNDONE = 0.5
"""Share of the cost that is left once a drift is undone, at most: of that as read, and of that with a delay undone,
which is no fault. Measured: of n = 9 drifts 0.17 or less is left of the cost as read; of a line through four parts of a
curved sensor, the one of 63 simulated recordings that has such, 0.99."""
STRAIGHT = 0.15
"""Share of that drift, beside `EARLY`, by which lags may lie off their line. Chosen: what friction does with the moment
of a start is less; not varied."""


def wandering(signals: Signals, part: Signals, given: Explained, nominal: Model) -> Fault | None:
    """The clocks of input and measured signal run at different rates: the lag grows with time.

    `given` is how the actuator explains a `part` of these signals, as they are read.
    """
    model = given.model if given.suffices else nominal
    rates = _rates(signals)
    by_rate = [_curves(signals.late_by(0.0, rate), model, given.length) for rate in rates]
    best = int(np.argmax([_common(curves) for curves in by_rate]))
    lags = np.array([_lag(curve) for curve in by_rate[best]])
    seen = lags[:, 1] >= SEEN
    if np.count_nonzero(seen) < TOLD or _common(by_rate[0][seen]) > PLAINLY * float(np.mean(lags[seen, 1])):
        return None
    middle = np.array([signals.time[int(np.median(each))] for each in _parts(signals.time.size)])
    late = signals.interval * lags[:, 0] + rates[best] * middle
    # takes a quarter of a second to load
    from scipy.stats import theilslopes

    slope, begin, *_ = theilslopes(late[seen], middle[seen])
    drift = abs(slope) * signals.duration
    told = seen & (np.abs(late - begin - slope * middle) <= EARLY * signals.interval + STRAIGHT * drift)
    if drift < DRIFTS * signals.interval or np.count_nonzero(told) < TOLD:
        return None
    slope, begin = np.polyfit(middle[told], late[told], 1, w=lags[told, 1])
    steady = float(np.average(late[told], weights=lags[told, 1]))
    alike = min(given.cost, explained(part.delayed(steady), nominal).cost)
    undone = explained(part.late_by(begin, slope), nominal)
    if undone.cost > UNDONE * alike or not undone.suffices:
        return None
    share, way = abs(slope), "fast" if slope < 0.0 else "slow"
    first, last = (1e3 * (begin + slope * at) for at in (signals.time[0], signals.time[-1]))
    evidence = (
        f"The shaft answers the {signals.input} {first:.3g} ms late at the beginning and {last:.3g} ms late at the end,"
        f" told in {np.count_nonzero(told)} of {PARTS} parts; what comes before its cause is negative."
    )
    mend = f"stamp {signals.input} and {signals.quantity} by one clock: choose it with --time stamp, publish or log"
    return Fault(signals.name, signals.input, f"clock {100.0 * share:.2g} % {way}", evidence, mend)


def _rates(signals: Signals) -> Signal:
    """By how much of each second the inputs are moved later, 0 first, so that any drift to `FARTHEST` stays in sight.

    From one to the next the lag at the end changes by the `BESIDE` samples that are looked at to either side.
    """
    step = BESIDE * signals.interval / float(signals.time[-1])
    count = math.ceil(FARTHEST / step)
    return np.concatenate([[0.0], step * np.arange(1, count + 1), -step * np.arange(1, count + 1)])


def _parts(samples: int) -> list[np.ndarray]:
    """The samples of each part, the last few of the recording, around which no change of velocity is told, left out."""
    return np.array_split(np.arange(samples - 2 * SHARPER), PARTS)


def _curves(signals: Signals, model: Model, length: float) -> Signal:
    """How well measured and simulated changes of velocity correlate in each part, shape (parts, lags)."""
    pieces = Fit(signals, model, length)
    bends = [_bends(each, pieces.cuts) for each in (pieces.angle, pieces.simulated(model))]
    return np.stack([_curve(*(each[part] for each in bends)) for part in _parts(signals.time.size)])


def _curve(measured: Signal, simulated: Signal) -> Signal:
    """How well the two correlate, with `measured` from `BESIDE` samples before to as many after; 0 if one is still."""
    lags, correlation = correlated(measured, simulated, min(BESIDE, measured.size - 1))
    found = np.zeros(2 * BESIDE + 1)
    found[BESIDE + lags.astype(int)] = correlation
    return found


def _lag(curve: Signal) -> tuple[float, float]:
    """By how many samples the measured signal comes after the simulated one where they correlate best, and how well."""
    best = int(np.argmax(curve))
    return float(best - BESIDE), float(curve[best])


def _common(curves: Signal) -> float:
    """How well the parts correlate at the one lag that does best for all. Slow motions correlate at any lag."""
    return float(np.max(np.mean(curves, axis=0), initial=0.0)) if len(curves) else 0.0


def early(signals: Signals, given: Explained) -> Fault | None:
    """The input comes after the motion that it causes: stamped late, or recorded too seldom.

    `given` is how the actuator explains a part of these signals.
    """
    pieces = Fit(signals, given.model, given.length)
    measured, simulated = (_bends(each, pieces.cuts) for each in (pieces.angle, pieces.simulated(given.model)))
    lags, correlation = correlated(measured, simulated, BESIDE)
    if not lags.size:
        return None
    place = int(np.argmax(correlation))
    best, unshifted = float(correlation[place]), float(correlation[lags == 0][0])
    if lags[place] > -EARLY or best < SEEN or unshifted > PLAINLY * best:
        return None
    late = -float(lags[place]) * signals.interval
    between = float(np.median(np.diff(signals.inputs.time))) if signals.inputs.time.size > 2 else 0.0
    evidence = (
        f"The shaft moves {1e3 * late:.3g} ms before the {signals.input} says so: changes of velocity correlate by"
        f" {best:.2f} then, by {unshifted:.2f} as it is read."
    )
    if between >= SELDOM * signals.interval and between / 4.0 <= late <= between:
        what = f"recorded every {1e3 * between:.3g} ms, where samples come every {1e3 * signals.interval:.3g} ms"
        mend = f"record each {signals.input} as it is applied; no line of a signal map brings back what lies between"
        return Fault(signals.name, signals.input, what, evidence, mend)
    return stamped_late(signals, late, evidence)


def stamped_late(signals: Signals, late: float, evidence: str) -> Fault:
    """The fault of inputs that carry a time `late` [s] after they acted."""
    what = f"stamped {1e3 * late:.3g} ms late"
    mend = f"choose the clock of the sender with --time stamp or --time publish, or record the applied {signals.input}"
    return Fault(signals.name, signals.input, what, evidence, mend)


def shift(signals: Signals, given: Explained) -> float:
    """By how much the inputs would have to come earlier or later for velocities to agree best [s], over any time."""
    pair = [np.gradient(each) for each in (given.measured, given.simulated)]
    lags, correlation = correlated(pair[0] - np.mean(pair[0]), pair[1] - np.mean(pair[1]), given.measured.size // 2)
    return float(lags[int(np.argmax(correlation))]) * signals.interval if lags.size else 0.0


def _bends(values: Signal, cuts: Sequence[int]) -> Signal:
    """Change of velocity around each sample, over `SHARPER` samples to either side; 0 around `cuts`."""
    rise = values[SHARPER:] - values[:-SHARPER]
    change = rise[SHARPER:] - rise[:-SHARPER]
    for cut in cuts:
        change[max(cut - 2 * SHARPER, 0) : cut] = 0.0
    return np.asarray(change)
