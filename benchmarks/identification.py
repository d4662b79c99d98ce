"""How often the identified intervals cover the truth: nominal valve, 3 mV noise, one recording a seed.

Run from the project root: python benchmarks/identification.py [--seeds 100]. Prints the table of
docs/identification.md.
"""

from __future__ import annotations

import argparse
import time

import numpy as np

from pierburg_ros.actuators import read_actuator
from pierburg_ros.identification.experiment.excitation import duty_sequence
from pierburg_ros.identification.experiment.synthetic import synthetic_recording
from pierburg_ros.identification.fit import fit
from pierburg_ros.identification.identify import free_names
from pierburg_ros.identification.paper.lumps import duties, fitted_lumps, lumps
from pierburg_ros.identification.paper.static_characteristic import static_characteristic
from pierburg_ros.plant import Model


def main() -> None:
    """Fit every seed's recording and print error and coverage of each quantity."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=100)
    parser.add_argument("--recipe", default="rich")
    parser.add_argument("--duration", type=float, default=60.0)
    options = parser.parse_args()
    model = Model.nominal(read_actuator("pierburg"))
    times = np.arange(round(options.duration * 500)) / 500.0
    names = free_names(model)
    truth = {**lumps(model), **duties(model), **{name: model.values[name] for name in names}}
    errors: dict[str, list[float]] = {name: [] for name in truth}
    covered: dict[str, list[bool]] = {name: [] for name in truth}
    began = time.perf_counter()
    for seed in range(options.seeds):
        duty = duty_sequence(options.recipe, model, times, seed)
        recording = synthetic_recording(model, times, duty, seed=1000 + seed)
        fitted = fit(model, [recording], names)
        found = {name: (lump.value, lump.ci95) for name, lump in fitted_lumps(fitted).items()}
        found.update({name: (value, fitted.ci95[name]) for name, value in fitted.values.items()})
        static = static_characteristic([recording], model.actuator)
        if static is not None:
            found["D_c"] = static.coulomb_duty.value, static.coulomb_duty.ci95
            found["D_pre"] = static.preload_duty.value, static.preload_duty.ci95
        for name, (value, interval) in found.items():
            errors[name].append(abs(value / truth[name] - 1.0))
            covered[name].append(interval is not None and interval[0] <= truth[name] <= interval[1])
    print(f"{options.seeds} seeds of {options.recipe}, {options.duration:g} s, 500 Hz, 3 mV")
    print("| quantity | largest error | covered |\n|---|---|---|")
    for name, hits in covered.items():
        print(f"| `{name}` | {100 * max(errors[name], default=0):.4f} % | {sum(hits)} of {len(hits)} |")
    print(f"{(time.perf_counter() - began) / options.seeds:.2f} s a seed")


if __name__ == "__main__":
    main()
