"""What a descent costs and where it ends: the estimation's own beside SciPy's, on trials that conceal an effect.

Run from the project root: python benchmarks/least_squares.py [--trials 2] [--effects sensor_lag ...]. Each trial is
drawn by the proof with a fixed seed. Its effect is fitted on top of what has drifted, from the two starts that a linear
step promises most of. All descents get the same differences, bounds, iterations and tolerance.
"""

from __future__ import annotations

import argparse
import os
import tempfile
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from machine import machine, write_section
from scipy import optimize
from threadpoolctl import threadpool_limits

from pierburg_ros.actuators import read_actuator
from pierburg_ros.diagnosis.diagnose import evidence
from pierburg_ros.diagnosis.search.candidates import starts_of
from pierburg_ros.diagnosis.search.linear import promised
from pierburg_ros.estimation.estimator import Estimator
from pierburg_ros.inference.coordinates import Coordinates
from pierburg_ros.inference.explanation import Explanation
from pierburg_ros.inference.least_squares import FULL, jacobian, minimise
from pierburg_ros.plant import Model
from pierburg_ros.proof.bench import record
from pierburg_ros.proof.concealment import draw
from pierburg_ros.proof.formulation.values import CATALOGUE
from pierburg_ros.proof.trial import Trial
from pierburg_ros.recording import read_recording

Residual = Callable[[np.ndarray], np.ndarray]
Descent = Callable[[Residual, np.ndarray, Coordinates], np.ndarray]

TOLERANCE = 1e-4  # relative gain of an iteration below which a descent ends
ALIKE = 1.02  # RMSE over the lowest of all descents from which one ended elsewhere
SEED = 1


def own(residual: Residual, start: np.ndarray, coordinates: Coordinates) -> np.ndarray:
    """Residual where the estimation's own descent ends."""
    return minimise(residual, start, *coordinates.bounds, coordinates.steps, FULL, TOLERANCE).residual


def scipy_descent(method: str) -> Descent:
    """A descent by `scipy.optimize.least_squares`, with the same differences as ours."""

    def descend(residual: Residual, start: np.ndarray, coordinates: Coordinates) -> np.ndarray:
        lower, upper = coordinates.bounds
        margin = 1e-9 * (upper - lower)  # SciPy wants a start within its bounds, not on them
        last: dict[bytes, np.ndarray] = {}

        def remembered(point: np.ndarray) -> np.ndarray:
            if point.tobytes() not in last:
                last.clear()
                last[point.tobytes()] = residual(point)
            return last[point.tobytes()]

        def slopes(point: np.ndarray) -> np.ndarray:
            return jacobian(residual, point, remembered(point), lower, upper, coordinates.steps)

        begin = np.clip(start, lower + margin, upper - margin)
        return optimize.least_squares(
            remembered, begin, slopes, (lower, upper), method=method,
            ftol=TOLERANCE, xtol=1e-9, gtol=1e-12, max_nfev=FULL,
        ).fun  # fmt: skip

    return descend


DESCENTS: dict[str, Descent] = {
    "estimation.least_squares": own,
    "SciPy trf": scipy_descent("trf"),
    "SciPy dogbox": scipy_descent("dogbox"),
}


@dataclass(frozen=True)
class Task:
    """An explanation to fit, and where to start."""

    estimator: Estimator
    explanation: Explanation
    start: dict[str, float]

    def cost(self, descend: Descent) -> tuple[float, int]:
        """RMSE over the noise where a descent ends, and the simulations that it took."""
        coordinates = self.estimator.coordinates(self.explanation)
        simulations = 0

        def residual(point: np.ndarray) -> np.ndarray:
            nonlocal simulations
            simulations += 1
            return self.estimator.residual_at(self.explanation, coordinates, point)

        ended = descend(residual, coordinates.point(self.start), coordinates)
        return float(np.sqrt(np.mean(ended**2))), simulations


def trials(count: int, effects: Sequence[str]) -> Iterator[Trial]:
    """The first `count` trials of each of some effects."""
    for kind in effects:
        yield from (draw(kind, number, SEED) for number in range(count))


def tasks(trial: Trial, folder: Path) -> Iterator[Task]:
    """The two most promising starts of each way in which the concealed effect may act."""
    nominal = Model.nominal(read_actuator("pierburg"))
    record(trial).write(folder / "train.mcap")
    data = evidence([read_recording(folder / "train.mcap")], nominal)
    estimator = Estimator(data, nominal)
    drifted = Explanation(tuple(name for name in nominal.actuator.free if name in trial.drifted))
    base = estimator.fit(drifted)
    for variant, starts in starts_of(data, base.model).items():
        if variant.effect in trial.effect_ids:
            for _, start in promised(estimator, base, variant, starts)[:2]:
                yield Task(estimator, drifted.plus(variant), {**base.values, **start})


def measured(count: int, effects: Sequence[str]) -> list[dict[str, tuple[float, int]]]:
    """What each descent made of each task."""
    rows = []
    with tempfile.TemporaryDirectory() as folder, threadpool_limits(1):
        for trial in trials(count, effects):
            found = [
                {name: task.cost(descend) for name, descend in DESCENTS.items()} for task in tasks(trial, Path(folder))
            ]
            print(trial.kind, found, flush=True)
            rows += found
    return rows


def table(rows: list[dict[str, tuple[float, int]]]) -> Iterator[str]:
    """How often each descent ends within 2 % of the lowest of all, and the simulations it took."""
    yield f"| descent | ends within {100 * (ALIKE - 1):.0f} % of the lowest | simulations |"
    yield "|---|---:|---:|"
    lowest = [min(error for error, _ in row.values()) for row in rows]
    for name in DESCENTS:
        alike = sum(row[name][0] <= ALIKE * least for row, least in zip(rows, lowest, strict=True))
        yield f"| {name} | {alike} of {len(rows)} | {sum(row[name][1] for row in rows):,} |"


def main() -> None:
    """Descend on every trial and write the section."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--trials", type=int, default=2, help="trials of each effect")
    parser.add_argument(
        "--effects", nargs="+", default=list(CATALOGUE), help="effects that are concealed; default: all"
    )
    parser.add_argument("--write", action=argparse.BooleanOptionalAction, default=True)
    options = parser.parse_args()
    load = os.getloadavg()[0]
    rows = measured(options.trials, options.effects)
    text = "\n".join(
        [
            "## Least squares",
            "",
            f"{machine()}. Load average of the machine before: {load:.1f}.",
            "",
            f"{len(options.effects)} effects, each fitted to {options.trials} trials that conceal it, seed {SEED}.",
            "",
            *table(rows), "",
            "Made by `python benchmarks/least_squares.py`.",
        ]
    )  # fmt: skip
    print(text)
    if options.write:
        write_section("least squares", text)


if __name__ == "__main__":
    main()
