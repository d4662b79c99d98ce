"""Causality: a shaft may answer its input late, for delays and lags exist, but never before."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.audit.explained import BESIDE, Explained, Fit, correlated
from pierburg_ros.audit.fault import Fault
from pierburg_ros.audit.signals import Signals

SHARPER = 10
"""Samples over which a velocity is told whose changes are compared. Chosen: 20 ms at 500 Hz; half of it drowns in
noise."""
EARLY = 2.5
"""Samples by which measured changes of velocity must come before the simulated ones. Derived: an input recorded one
sample late, as one sample may be, and the rounding of the lag."""
PLAINLY = 0.9
"""Share of the best agreement that is left without a shift, at most. Measured: clean recordings keep 0.97 or more where
their best lag is early (n = 30)."""
SEEN = 0.4
"""Correlation of changes of velocity from which a lag is seen. Measured: with less the best lag lies anywhere in clean
recordings (n = 52)."""
SELDOM = 5.0
"""Sample intervals between two inputs from which the input is recorded too seldom. Chosen: a controller that runs at a
fifth of the sensor's rate is rare, and one that is early besides is not run at that rate."""


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
