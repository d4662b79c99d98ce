"""The same recordings in other units: how often the diagnosis says the same.

    python benchmarks/gauges.py --output gauges.jsonl [--document] [--only viscous_friction]

Each effect that is searched for, each drift and nothing at all, in 12 s of steps of duty made by the simulator, is
diagnosed as it is and with torques, times and, where the angle is measured, angles multiplied. Called again with the
same output it goes on. `--document` writes the table into docs/developers/measurements.md.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from machine import machine, write_section
from pierburg_ros.diagnosis.search.candidates import possible

from pierburg_ros.actuators import Actuator, read_actuator
from pierburg_ros.diagnosis.diagnose import diagnose
from pierburg_ros.diagnosis.schema import Diagnosis
from pierburg_ros.plant import Inputs, Model, simulate
from pierburg_ros.proof.gauge import Gauge
from pierburg_ros.recording import Channel, Recording

HALL = read_actuator("pierburg")
POSITION = replace(HALL, quantity="position")
AS_IT_IS = "as it is"
GAUGES = {
    "torques x 100, times x 10": Gauge(torque=100.0, time=10.0),
    "angles x 20": Gauge(angle=20.0),
    "torques x 100": Gauge(torque=100.0),
    "torques / 100": Gauge(torque=0.01),
    "times x 10": Gauge(time=10.0),
    "times / 10": Gauge(time=0.1),
}
DURATION = 12.0
"""Length of a recording [s], as it is."""
DRIFT = 1.12
"""Factor of a parameter that has drifted."""
STRONG = {"external_load": {"torque": 0.0}, "input_delay": {"delay": 0.1}, "sensor_lag": {"time_constant": 0.1}}
"""What of the typical values is otherwise: one way to act, and delays of a few samples, that steps of duty show."""
ALIKE = 1e-3
"""Largest relative difference of values, and of ends of windows to the recording, that counts as none."""


def main() -> None:
    """Diagnose what the output does not hold yet, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--output", type=Path, default=Path("gauges.jsonl"))
    parser.add_argument("--only", nargs="*", help="cases to run")
    parser.add_argument("--jobs", type=int)
    parser.add_argument("--document", action="store_true")
    given = parser.parse_args()
    lines = [json.loads(line) for line in given.output.read_text().splitlines()] if given.output.exists() else []
    done = {(line["case"], line["sensor"], line["gauge"]) for line in lines}
    with given.output.open("a") as output:
        for case, actuator, name, gauge in tasks():
            key = (case, actuator.quantity, name)
            if key in done or (given.only and case not in given.only):
                continue
            done.add(key)
            line = {
                "case": case,
                "sensor": actuator.quantity,
                "gauge": name,
                **diagnosed(case, actuator, gauge, given.jobs),
            }
            lines.append(line)
            print(line, flush=True)
            output.write(json.dumps(line) + "\n")
            output.flush()
    text = "\n".join(table(lines))
    print(text)
    if given.document:
        write_section("gauges", f"## Units\n\n{HEAD}\n\n{machine()}\n\n{text}\n")


HEAD = """\
What is said of a recording may not depend on the units that it is given in. The valve with each effect that is searched
for, with each drift, and as described, was diagnosed from 12 s of steps of duty, and again with all torques, times or
(where the angle is measured) angles multiplied. The same means: the same verdict, effects and drifts; each end of each
window moved by less than 0.1 % of the recording; values that differ by less than 0.1 %."""


def cases(actuator: Actuator) -> dict[str, dict[str, float]]:
    """What is wrong with the actuator, by name."""
    nominal = Model.nominal(actuator)
    effects = {
        effect.id: effect.typical_values(nominal.values, nominal.scales)
        | {f"{effect.id}.{name}": v for name, v in effect.in_units(STRONG.get(effect.id, {}), nominal.scales).items()}
        for effect in possible(actuator)
    }
    drifts = {f"drift of {name}": {name: nominal.values[name] * DRIFT} for name in actuator.free}
    return {"nothing": {}, **effects, **drifts}


def tasks() -> Iterator[tuple[str, Actuator, str, Gauge]]:
    """Every case in every gauge, gauge by gauge, each beside what is said as it is."""
    for name, gauge in GAUGES.items():
        actuator = HALL if gauge.angle == 1.0 else POSITION
        for case in cases(actuator):
            yield case, actuator, AS_IT_IS, Gauge()
            yield case, actuator, name, gauge


def recorded(actuator: Actuator, values: dict[str, float]) -> Recording:
    """Random steps of duty at 500 Hz, with a noise of 0.07 % of the travel."""
    random = np.random.default_rng(0)
    moments = np.arange(0.0, DURATION, 0.002)
    duty = random.uniform(-0.05, 0.36, int(DURATION / 0.6) + 1)[(moments / 0.6).astype(int)]
    duty[moments < 0.3] = 0.0
    model = Model.nominal(actuator).with_values(values)
    signal = simulate(model, Inputs(moments, duty), moments)
    noise = 0.00073 * model.scales.reading * random.standard_normal(moments.size)
    return Recording("made", actuator.quantity, moments, signal + noise, Channel(moments, duty))


def diagnosed(case: str, actuator: Actuator, gauge: Gauge, jobs: int | None) -> dict[str, Any]:
    """What is said of a case in the units of `gauge`, brought back from them."""
    recording = gauge.recording(recorded(actuator, cases(actuator)[case]))
    began = time.monotonic()
    found = diagnose([recording], Model.nominal(gauge.actuator(actuator)), jobs=jobs).diagnosis
    return {**said(found, gauge), "seconds": round(time.monotonic() - began, 1)}


def said(found: Diagnosis, gauge: Gauge) -> dict[str, Any]:
    """Verdict, names, values and windows, brought back from the units of `gauge`."""
    values = {
        f"{effect.id}.{name}": estimate.value / gauge.factor(f"{effect.id}.{name}", estimate.unit)
        for effect in found.effects
        for name, estimate in effect.parameters.items()
        if estimate.value is not None
    }
    drifted = {name: p for name, p in found.parameters.items() if p.drifted and p.value is not None}
    values |= {name: p.value / gauge.factor(name, p.unit) for name, p in drifted.items()}
    return {
        "verdict": found.verdict,
        "names": [*(effect.id for effect in found.effects), *drifted, *(change.parameter for change in found.changes)],
        "values": values,
        "windows": [(window.start / gauge.time, window.end / gauge.time) for window in found.locations],
    }


def table(lines: list[dict[str, Any]]) -> Iterator[str]:
    """How often each gauge changed nothing."""
    own = {(line["case"], line["sensor"]): line for line in lines if line["gauge"] == AS_IT_IS}
    yield "| units | verdict and names the same | windows the same | values the same | largest difference of a value |"
    yield "|---|---|---|---|---|"
    different = []
    for name in GAUGES:
        pairs = [(own[line["case"], line["sensor"]], line) for line in lines if line["gauge"] == name]
        same = [base["verdict"] == other["verdict"] and base["names"] == other["names"] for base, other in pairs]
        windows = [alike_windows(base["windows"], other["windows"]) for base, other in pairs]
        apart = [difference(base["values"], other["values"]) for base, other in pairs]
        n = len(pairs)
        if n == 0:
            continue
        close = sum(each < ALIKE for each in apart)
        worst = max((each for each, named in zip(apart, same, strict=True) if named), default=0.0)
        yield f"| {name} | {sum(same)} of {n} | {sum(windows)} of {n} | {close} of {n} | {worst:.1g} |"
        different += [f"{other['case']} ({name})" for (_, other), named in zip(pairs, same, strict=True) if not named]
    yield ""
    yield f"Otherwise named: {', '.join(different) or 'none'}."


def alike_windows(one: list[list[float]], other: list[list[float]]) -> bool:
    """Whether windows are the same but for what rounding may do."""
    return len(one) == len(other) and np.allclose(sorted(one), sorted(other), rtol=0.0, atol=ALIKE * DURATION)


def difference(one: dict[str, float], other: dict[str, float]) -> float:
    """Largest relative difference of values by name; infinite where names differ."""
    if set(one) != set(other):
        return float("inf")
    return max((abs(other[name] - value) / max(abs(value), 1e-300) for name, value in one.items()), default=0.0)


if __name__ == "__main__":
    main()
