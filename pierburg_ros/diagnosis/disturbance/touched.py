"""For simulations in stretches: stretches are left out if nothing that acts elsewhere explains them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from pierburg_ros.arrays import Flags
from pierburg_ros.diagnosis.disturbance.window import LONGEST
from pierburg_ros.diagnosis.search.candidates import drifting
from pierburg_ros.estimation.data import Data, Omission, data_of, in_parts, rms
from pierburg_ros.estimation.estimator import Estimator
from pierburg_ros.estimation.torque_balance import OUTLYING
from pierburg_ros.inference.explanation import Explanation
from pierburg_ros.inference.least_squares import BRIEF
from pierburg_ros.plant import Model
from pierburg_ros.recording import Recording
from pierburg_ros.recording.loss import Span, merged, spans_of

TOUCHED = "nothing that acts elsewhere explains it, as if the shaft had been pushed or held"
"""The reason for leaving out a stretch."""
ROUNDS = 5
"""How often stretches are set apart and the others are fitted again. Work: each time is a brief fit; pushed runs (n =
3) needed two or three."""


def untouched(data: Data, nominal: Model, recordings: Sequence[Recording]) -> Data | None:
    """`data` without the stretches whose error lies far above that of all others; None where there are none.

    None also where an actuator is not simulated in stretches: it forgets its initial state by itself.

    A push on a pendulum is over after a stretch or two, but its squared error may dominate the fit. None also if the
    stretches are more than a quarter of the recordings: then an effect acts there.
    """
    if any(run.shooting is None for run in data.runs):
        return None
    spans = _touched(data, nominal)
    share = sum(end - start for each in spans.values() for start, end in each)
    if not spans or share > LONGEST * sum(float(run.time[-1] - run.time[0]) for run in data.runs):
        return None
    omissions = tuple(Omission(number, span, TOUCHED) for number, each in spans.items() for span in each)
    rest = in_parts(data_of(recordings, nominal, omissions))
    names = {run.number: run.name for run in data.runs}
    remarks = tuple(f"{names[number]}: {_told(each)} {TOUCHED}; it is left out." for number, each in spans.items())
    kept = tuple(each for each in data.left_out if each not in rest.left_out)
    return replace(rest, left_out=(*rest.left_out, *kept), remarks=(*data.remarks, *remarks), unlike=data.unlike)


def _touched(data: Data, nominal: Model) -> dict[int, tuple[Span, ...]]:
    """The spans [s] with an error far above the others, by the number of their recording."""
    drifts, kept = Explanation(drifting(nominal)), np.ones(data.train.size, dtype=bool)
    for _ in range(ROUNDS):
        fit = Estimator(_trained_on(data, kept), nominal).fit(drifts, iterations=BRIEF, forgiving=True)
        before, kept = kept, _inlying(data, fit.model)
        if np.array_equal(before, kept):
            break
    found: dict[int, list[Span]] = {}
    for run, inside in zip(data.runs, _of_runs(data, kept), strict=True):
        if spans := spans_of(run.time, ~inside):
            found.setdefault(run.number, []).extend(spans)
    return {number: merged(tuple(spans)) for number, spans in found.items()}


def _inlying(data: Data, model: Model) -> Flags:
    """Which samples belong to stretches whose error is not far above the median of all stretches, shape (samples,)."""
    lengths, errors = [], []
    for run, residual in zip(data.runs, _of_runs(data, data.residual(model)), strict=True):
        assert run.shooting is not None
        parts = np.split(residual, run.shooting.first[1:])
        lengths += [part.size for part in parts]
        errors += [rms(part) for part in parts]
    return np.repeat(np.array(errors) <= OUTLYING * np.median(errors), lengths)


def _trained_on(data: Data, kept: Flags) -> Data:
    pairs = zip(data.runs, _of_runs(data, kept), strict=True)
    return replace(data, runs=tuple(run.trained_on(inside) for run, inside in pairs))


def _of_runs(data: Data, values: np.ndarray) -> list[np.ndarray]:
    return np.split(values, np.cumsum([run.time.size for run in data.runs])[:-1])


def _told(spans: Sequence[Span]) -> str:
    return "from " + ", ".join(f"{start:.3g} to {end:.3g}" for start, end in spans) + " s"
