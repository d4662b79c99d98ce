"""The simulator: beside SciPy's LSODA and MuJoCo, with effects, many parameter sets, memory, first and later start.

python benchmarks/simulator.py writes its section of docs/developers/measurements.md; --no-write only prints.
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import peers
from machine import machine, write_section

from pierburg_ros.actuators import read_actuator
from pierburg_ros.plant import Inputs, Model, simulate, simulate_many

NOMINAL = Model.nominal(read_actuator("pierburg"))
CASES: dict[str, dict[str, float]] = {
    "nominal": {},
    "static friction, load-dependent friction, sensor lag": {
        "static_friction.breakaway_torque": 0.26, "static_friction.stribeck_velocity": 0.1,
        "load_dependent_friction.coefficient": 0.05, "sensor_lag.time_constant": 0.008,
    },
    "supply sag, nonlinear spring, input delay": {
        "supply_sag.source_resistance": 1.0, "nonlinear_spring.cubic_stiffness": 0.03, "input_delay.delay": 0.01,
    },
    "cogging, viscous friction, thermal resistance": {
        "cogging_torque.amplitude": 0.02, "cogging_torque.periods_per_motor_revolution": 3.0,
        "viscous_friction.coefficient": 0.03, "thermal_resistance.thermal_resistance": 20.0,
        "thermal_resistance.heat_capacity": 0.5,
    },
    "backlash, external load, position-dependent friction": {
        "backlash.gap": 0.03, "backlash.motor_friction_share": 0.3,
        "external_load.amplitude": 0.03, "external_load.frequency": 1.0, "external_load.end": 60.0,
        "position_dependent_friction.amplitude": 0.04, "position_dependent_friction.center": 0.8,
        "position_dependent_friction.width": 0.1,
    },
    "presliding": {"presliding.stiffness": 15.0, "presliding.damping": 0.02},
    "presliding, gear compliance": {
        "presliding.stiffness": 15.0, "presliding.damping": 0.02,
        "gear_compliance.stiffness": 12.0, "gear_compliance.damping": 0.01,
    },
}  # fmt: skip
SETS = 1000
START = "import time; begin = time.perf_counter(); {first}; import numpy as np; " + (
    "from pierburg_ros.actuators import read_actuator; from pierburg_ros.plant import Inputs, Model, simulate; "
    "model = Model.nominal(read_actuator('pierburg')); imported = time.perf_counter(); "
    "simulate(model, Inputs(np.array([0.0]), np.array([0.2])), np.arange(100) / 500.0); "
    "print(imported - begin, time.perf_counter() - imported)"
)
LIBRARIES = "import numpy, numba, scipy, yaml, pydantic"
MEMORY = (
    "import sys; from simulator import NOMINAL, drive, highest; "
    "from pierburg_ros.plant import simulate, simulate_many; inputs, times = drive(60.0, 500.0); "
    "simulate(NOMINAL, inputs, times); before = highest(); "
    "signals = simulate_many([NOMINAL] * int(sys.argv[1]), inputs, times); "
    "print(highest() - before, signals.nbytes / 2**20)"
)


def highest() -> float:
    """Most memory that this process has held so far [MiB]."""
    status = Path("/proc/self/status").read_text()
    return float(next(line.split()[1] for line in status.splitlines() if line.startswith("VmHWM"))) / 1024.0


def drive(duration: float, rate: float, seed: int = 1) -> tuple[Inputs, np.ndarray]:
    """Random duty steps of 0.3 to 0.9 s between rest and full travel, sampled at `rate` [Hz]."""
    random = np.random.default_rng(seed)
    changes = np.concatenate([[0.0], np.cumsum(random.uniform(0.3, 0.9, int(duration / 0.3)))])
    changes = changes[changes < duration]
    return Inputs(changes, random.uniform(-0.05, 0.35, changes.size)), np.arange(round(duration * rate)) / rate


def best(work: Callable[[], object], repeats: int) -> float:
    """Shortest and therefore least disturbed time of some calls [s]."""
    taken = []
    for _ in range(repeats):
        begin = time.perf_counter()
        work()
        taken.append(time.perf_counter() - begin)
    return min(taken)


def beside_peers() -> list[str]:
    """10 s at 1 kHz of the nominal plant: time, and how far the angle is from ours."""
    inputs, times = drive(10.0, 1000.0)
    exact = simulate(NOMINAL, inputs, times)
    ours = best(lambda: simulate(NOMINAL, inputs, times), 200)
    lines = [
        f"Nominal plant, 10 s at 1 kHz, {inputs.time.size} duty steps:",
        "",
        "| simulator | time | beside ours | Hall voltage off by (RMS / largest) | creep of a stuck shaft |",
        "|---|---:|---:|---:|---:|",
        f"| pierburg_ros | {1e6 * ours:.0f} us | 1 | | {1e3 * peers.creep(ours_for_creep):.3f} mrad/s |",
    ]
    for name, (run, repeats) in peers.available().items():
        voltage = run(inputs, times)
        off = 1e3 * (voltage - exact)
        taken = best(lambda run=run: run(inputs, times), repeats)
        lines.append(
            f"| {name} | {1e3 * taken:.1f} ms | {taken / ours:.0f} | {np.sqrt(np.mean(off**2)):.2f} / "
            f"{np.max(np.abs(off)):.1f} mV | {1e3 * peers.creep(run):.3f} mrad/s |"
        )
    return lines


def ours_for_creep(inputs: Inputs, times: np.ndarray) -> np.ndarray:
    """Our Hall voltage, as the peers give theirs."""
    return simulate(NOMINAL, inputs, times)


def with_effects() -> list[str]:
    """60 s at 500 Hz with effects; the drive goes through rest, both directions and both stops."""
    inputs, times = drive(60.0, 500.0)
    lines = ["60 s at 500 Hz, every effect compiled in, these active:", "", "| effects | time |", "|---|---:|"]
    for name, values in CASES.items():
        model = NOMINAL.with_values(values)
        simulate(model, inputs, times)
        lines.append(f"| {name} | {1e3 * best(lambda m=model: simulate(m, inputs, times), 15):.2f} ms |")
    return lines


def many_sets() -> list[str]:
    """Sets a second on one core and on two, the runs taking turns so that both see the same machine."""
    inputs, times = drive(60.0, 500.0)
    random = np.random.default_rng(2)
    lag = list(CASES.values())[1]
    sets = [NOMINAL.with_values({**lag, "armature_resistance": float(random.uniform(3.5, 6.0))}) for _ in range(SETS)]
    rates: dict[int, list[float]] = {1: [], 2: []}
    for _ in range(3):
        for threads, found in rates.items():
            taken = best(lambda threads=threads: simulate_many(sets, inputs, times, jobs=threads), 1)
            found.append(SETS / taken)
    one, two = (statistics.median(found) for found in rates.values())
    return [
        f"{SETS} parameter sets over 60 s at 500 Hz, three effects active: {one:.0f} sets a second on one core, "
        f"{two:.0f} on two ({two / one:.2f} times)."
    ]


def memory() -> list[str]:
    """Memory that many sets take beyond their outputs, each count in a process of its own."""
    lines = ["| sets | outputs | taken beyond them |", "|---:|---:|---:|"]
    for sets in (10, 100, SETS):
        taken, outputs = child(MEMORY, str(sets))
        lines.append(f"| {sets} | {outputs:.0f} MiB | {taken - outputs:.1f} MiB |")
    return lines


def starts() -> list[str]:
    """First use on a fresh machine, later starts, and the libraries alone, each in a process of its own."""
    with tempfile.TemporaryDirectory() as cache:
        environment = {"XDG_CACHE_HOME": cache}
        first = child(START.format(first="pass"), environment=environment)
        later = [child(START.format(first=LIBRARIES), environment=environment) for _ in range(3)]
        libraries = [
            child(f"import time; b = time.perf_counter(); {LIBRARIES}; print(time.perf_counter() - b)")[0]
            for _ in range(3)
        ]
    whole = min(sum(times) for times in later)
    return [
        f"First run on a machine without a cache: {first[1]:.1f} s to compile, said on standard error. Later starts: "
        f"{whole - min(libraries):.2f} s beyond importing the libraries ({min(libraries):.2f} s), of which "
        f"{min(times[1] for times in later):.2f} s load the compiled simulator and run it once."
    ]


def child(code: str, *arguments: str, environment: dict[str, str] | None = None) -> list[float]:
    """The numbers that some code prints in a Python of its own."""
    folder = os.path.dirname(__file__)
    done = subprocess.run(
        [sys.executable, "-c", code, *arguments],
        env={**os.environ, **(environment or {})}, cwd=folder, capture_output=True, text=True, check=True,
    )  # fmt: skip
    return [float(word) for word in done.stdout.split()]


def main() -> None:
    """Measure everything and write the section."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action=argparse.BooleanOptionalAction, default=True)
    options = parser.parse_args()
    text = "\n".join(
        [
            "## Simulator",
            "",
            f"{machine()}. Load average of the machine before: {os.getloadavg()[0]:.1f}. Times are the best of many.",
            "",
            *beside_peers(), "", *with_effects(), "", *many_sets(), "", *memory(), "", *starts(), "",
            "Made by `python benchmarks/simulator.py`; what the peers were given is in `benchmarks/peers.py`.",
        ]
    )  # fmt: skip
    print(text)
    if options.write:
        write_section("simulator", text)


if __name__ == "__main__":
    main()
