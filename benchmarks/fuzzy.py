"""One fuzzy inference, compiled, from Python, and by scikit-fuzzy.

python benchmarks/fuzzy.py writes its section of docs/developers/measurements.md; --no-write only prints.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from typing import Any

import numpy as np
from machine import machine, write_section

from pierburg_ros.control import Controller, Settings
from pierburg_ros.control.fuzzy import duty_of
from pierburg_ros.kernel import kernel

INPUTS = np.random.default_rng(1).uniform(-1.0, 1.0, (1000, 2))
PEAKS = {"N": -1.0, "Z": 0.0, "P": 1.0}
NAMES = ("negative_big", "negative", "zero", "positive", "positive_big")


@kernel
def infer_all(settings: Any, inputs: Any) -> float:
    """Sum of the duties for all inputs, given as shares of the supports."""
    total = 0.0
    for row in range(inputs.shape[0]):
        pi_output = inputs[row, 0] * settings.pi_output_support
        total += duty_of(settings, pi_output, inputs[row, 1] * settings.derivative_support)
    return total


def scikit_fuzzy_stage(settings: Settings) -> Callable[[float, float], None]:
    """The same stage in scikit-fuzzy: 3 x 3 rules, output sets on 201 points, centroid."""
    from skfuzzy import control, trimf

    universe = np.linspace(-1.1, 1.1, 201)
    antecedents = [control.Antecedent(np.linspace(-1.0, 1.0, 3), name) for name in ("row", "column")]
    for antecedent in antecedents:
        for name, peak in PEAKS.items():
            antecedent[name] = trimf(antecedent.universe, [peak - 1.0, peak, peak + 1.0])
    duty = control.Consequent(universe, "duty")
    for name in NAMES:
        centre = getattr(settings, name)
        duty[name] = trimf(universe, [centre - 0.1, centre, centre + 0.1])
    rules = [
        control.Rule(antecedents[0][row] & antecedents[1][column], duty[NAMES[i + j]])
        for i, row in enumerate(PEAKS)
        for j, column in enumerate(PEAKS)
    ]
    stage = control.ControlSystemSimulation(control.ControlSystem(rules), cache=False)

    def infer(row: float, column: float) -> None:
        stage.input["row"], stage.input["column"] = row, column
        stage.compute()

    return infer


def per_call(action: Callable[[], object], calls: int) -> float:
    """Best of five mean durations [us]."""
    durations = []
    for _ in range(5):
        began = time.perf_counter()
        action()
        durations.append(time.perf_counter() - began)
    return 1e6 * min(durations) / calls


def main() -> None:
    """Measure microseconds per call and write the section."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action=argparse.BooleanOptionalAction, default=True)
    options = parser.parse_args()
    settings = Settings()
    record, controller = settings.record(), Controller(settings)
    infer_all(record, INPUTS)
    controller.step(0.5, 1.0, 0.002)
    figures = {
        "fuzzy stage, compiled": per_call(lambda: infer_all(record, INPUTS), len(INPUTS)),
        "fuzzy stage, called from Python": per_call(lambda: [duty_of(record, 0.1, 10.0) for _ in range(1000)], 1000),
        "whole controller, one sample, called from Python": per_call(
            lambda: [controller.step(0.5, 1.0, 0.002) for _ in range(1000)], 1000
        ),
    }
    try:
        infer = scikit_fuzzy_stage(settings)
        figures["scikit-fuzzy, same rules"] = per_call(lambda: [infer(*each) for each in INPUTS[:50]], 50)
    except ImportError:
        print("scikit-fuzzy is not installed; its row is left out.")
    rows = [f"| {name} | {duration:.3g} |" for name, duration in figures.items()]
    title, made = f"## Fuzzy inference\n\n{machine()}.\n", "\nMade by `python benchmarks/fuzzy.py`."
    text = "\n".join([title, "| one call | us |", "|---|---:|", *rows, made])
    print(text)
    if options.write:
        write_section("fuzzy inference", text)


if __name__ == "__main__":
    main()
