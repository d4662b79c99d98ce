"""Faults of the input, made from practice and real recordings, and what the audit says: writes docs/input_faults.md.

`python benchmarks/input_faults.py --shared ../shared` takes some minutes. `--trials FOLDER` adds blind trials, whose
recordings are clean.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from rotor import slow

from pierburg_ros.actuators import read_actuator
from pierburg_ros.audit import audit
from pierburg_ros.effects import EFFECTS, Effect
from pierburg_ros.effects.put_in import CannotPutIn
from pierburg_ros.errors import InputError
from pierburg_ros.identification.description.told import RESOLUTION
from pierburg_ros.identification.description.told import bench as standard
from pierburg_ros.identification.experiment.synthetic import synthetic_recording
from pierburg_ros.inference.coordinates import in_order
from pierburg_ros.library.reading import read
from pierburg_ros.plant import Model
from pierburg_ros.plant.decode import decoded_value
from pierburg_ros.plant.plant import Plant
from pierburg_ros.proof.excitation import duty_sequence
from pierburg_ros.proof.real.channels import with_effect
from pierburg_ros.proof.real.strengths import possible, values_at
from pierburg_ros.proof.real.strengths import strength as strongest
from pierburg_ros.recording import Channel, Recording, read_recording
from pierburg_ros.recording.read import check_bounds

PAGE = Path(__file__).parent.parent / "docs/input_faults.md"
Make = Callable[[Recording, Recording], list[Recording]]


@dataclass(frozen=True)
class Made:
    """A fault: what it is called, how it is made of a recording and another one, and which words must name it."""

    name: str
    make: Make
    signals: tuple[str, ...]
    named: str
    on: tuple[str, ...] = ("valve", "bench")


def measured(change: Callable[[np.ndarray], np.ndarray]) -> Make:
    return lambda one, other: [replace(one, measured=change(one.measured))]


def counted(per_unit: float) -> Make:
    return measured(lambda values: np.round(per_unit * values))


def duty(change: Callable[[np.ndarray], np.ndarray]) -> Make:
    return lambda one, other: [replace(one, command=Channel(one.command.time, change(one.command.values)))]


def supply(change: Callable[[np.ndarray], np.ndarray]) -> Make:
    def make(one: Recording, other: Recording) -> list[Recording]:
        given = one.supply_voltage or Channel(one.time[:1], np.array([13.5]))
        return [replace(one, supply_voltage=Channel(given.time, change(given.values)))]

    return make


def timed(factor: float) -> Make:
    def make(one: Recording, other: Recording) -> list[Recording]:
        channels = {
            name: Channel(factor * channel.time, channel.values)
            for name in ("command", "supply_voltage", "enabled", "setpoints")
            if (channel := getattr(one, name)) is not None
        }
        changed = replace(one, time=factor * one.time, temperature=None, losses=(), **channels)
        check_bounds(changed)
        return [changed]

    return make


def later(by: float) -> Make:
    return lambda one, other: [replace(one, command=Channel(one.command.time + by, one.command.values))]


def at_rate(rate: float) -> Make:
    return lambda one, other: [replace(one, command=Channel(rate * one.command.time, one.command.values))]


def seldom(one: Recording, other: Recording) -> list[Recording]:
    return [replace(one, command=Channel(one.command.time[::10], one.command.values[::10]))]


def another_run(one: Recording, other: Recording) -> list[Recording]:
    return [replace(one, command=other.command)]


def reversed_in_time(one: Recording, other: Recording) -> list[Recording]:
    return [replace(one, command=Channel(one.command.time, one.command.values[::-1]))]


def setpoint(one: Recording, other: Recording) -> list[Recording]:
    return [replace(one, command=one.setpoints)] if one.setpoints is not None else []


def setpoint_of_travel(one: Recording, other: Recording) -> list[Recording]:
    if one.setpoints is None:
        return []
    inside = np.clip(one.setpoints.values / (np.pi / 2), -1.0, 1.0)
    return [replace(one, command=Channel(one.setpoints.time, inside))]


def swapped(one: Recording, other: Recording) -> list[Recording]:
    return [replace(one, measured=one.command.at(one.time), command=Channel(one.time, one.measured))]


FAULTS = (
    Made("duty: polarity reversed", duty(lambda d: -d), ("duty", "position"), "polarity"),
    Made("duty: percent for fractions", duty(lambda d: 100 * d), ("duty",), "percent"),
    Made("duty: counts of 10 bit for fractions", duty(lambda d: np.round(1023 * d)), ("duty",), "counts"),
    Made("duty: divided by 100 twice", duty(lambda d: d / 100), ("duty",), "hundredth"),
    Made("duty: 0.5 stands for none", duty(lambda d: 0.5 + 0.5 * d), ("duty",), "0.5"),
    Made("duty: magnitude without sign", duty(np.abs), ("duty",), "", on=("bench",)),
    Made("duty: of another run", another_run, ("duty",), "does not cause"),
    Made("duty: run backwards", reversed_in_time, ("duty",), "does not cause"),
    Made("duty: stamped 20 ms late", later(0.02), ("duty",), "late"),
    Made("duty: stamped 50 ms late", later(0.05), ("duty",), "late"),
    Made("duty: stamped 1 s late", later(1.0), ("duty",), "late"),
    Made("duty: clock 0.2 % fast", at_rate(1.002), ("duty",), "fast", on=("valve",)),
    Made("duty: clock 1 % fast", at_rate(1.01), ("duty",), "fast"),
    Made("duty: logged at a tenth of the rate", seldom, ("duty",), ""),
    Made("duty: setpoint in its place [rad]", setpoint, ("duty",), "setpoint"),
    Made("duty: setpoint in its place, share of the travel", setpoint_of_travel, ("duty",), "setpoint", on=("valve",)),
    Made("duty: constant", duty(lambda d: np.zeros_like(d)), ("duty",), ""),
    Made("duty and sensor swapped", swapped, ("duty", "hall_voltage", "position"), "", on=("valve",)),
    Made("duty and sensor swapped", swapped, ("duty", "position"), "exchanged", on=("bench",)),
    Made("sensor: polarity reversed", measured(lambda v: 4.94 - v), ("hall_voltage",), "polarity", on=("valve",)),
    Made("sensor: polarity reversed", measured(lambda v: -v), ("position", "duty"), "polarity", on=("bench",)),
    Made("sensor: negated", measured(lambda v: -v), ("hall_voltage",), "negated", on=("valve",)),
    Made("sensor: millivolts for volts", measured(lambda v: 1e3 * v), ("hall_voltage",), "thousandths", on=("valve",)),
    Made("sensor: counts, 12 bit over 5 V", counted(819), ("hall_voltage",), "counts", on=("valve",)),
    Made("sensor: counts, 10 bit over 5 V", counted(204.6), ("hall_voltage",), "counts", on=("valve",)),
    Made("sensor: behind a divider by 2", measured(lambda v: 0.5 * v), ("hall_voltage",), "scale", on=("valve",)),
    Made("sensor: gain of 2", measured(lambda v: 2.0 * v), ("hall_voltage",), "scale", on=("valve",)),
    Made("sensor: zero off by 1 V", measured(lambda v: v + 1.0), ("hall_voltage",), "zero", on=("valve",)),
    Made("sensor: zero off by -0.4 V", measured(lambda v: v - 0.4), ("hall_voltage",), "zero", on=("valve",)),
    Made("sensor: degrees for radians", measured(np.rad2deg), ("position",), "degrees", on=("bench",)),
    Made("sensor: counts, 4096 a turn", counted(4096 / 2 / np.pi), ("position",), "counts", on=("bench",)),
    Made("sensor: turns for radians", measured(lambda a: a / 2 / np.pi), ("position",), "turns", on=("bench",)),
    Made("sensor: radians taken for degrees", measured(np.deg2rad), ("position",), "degrees", on=("bench",)),
    Made("sensor: constant", measured(lambda v: np.full_like(v, v[0])), ("hall_voltage", "position"), "constant"),
    Made("time: milliseconds for seconds", timed(1e3), ("time",), "unit: ms"),
    Made("time: microseconds for seconds", timed(1e6), ("time",), "unit: us"),
    Made("time: nanoseconds for seconds", timed(1e9), ("time",), "unit: ns"),
    Made("time: a thousandth", timed(1e-3), ("time",), "unit: s"),
    Made("supply voltage: millivolts for volts", supply(lambda v: 1e3 * v), ("supply_voltage",), "millivolts"),
)  # fmt: skip


def told(make: Make, one: Recording, other: Recording, nominal: Model) -> list[str] | None:
    """What is said of a faulty recording, a line each; None where the fault cannot be made of it."""
    try:
        made = make(one, other)
        return [str(fault) for fault in audit(made, nominal)] if made else None
    except InputError as refused:
        return [str(refused)]


def is_found(fault: Made, lines: list[str]) -> bool:
    """Whether one of the lines blames a right signal in the right words."""
    return any(any(signal in line for signal in fault.signals) and fault.named in line for line in lines)


VALVE, BENCH, PENDULUM, ROTOR = (Model.nominal(read_actuator(name)) for name in ("pierburg", "xl330", "ak80", "odrive"))
RUNS = {
    "valve": [(f"practice-{one:02}", f"practice-{(one + 5) % 22:02}") for one in (1, 10, 13, 19)],
    "bench": [
        ("kp100_sin_sin", "kp400_sin_time_square"),
        ("kp100_lift_and_drop", "kp400_sin_sin"),
        ("kp400_up_and_down", "kp100_sin_sin"),
    ],
}


def main() -> None:
    """Make every fault of every recording, hold clean ones against the same audit, write the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--shared", type=Path, default=Path("../shared"))
    parser.add_argument("--trials", type=Path, help="a folder of blind trials, */train.mcap")
    parser.add_argument("--output", type=Path, default=PAGE)
    options = parser.parse_args()
    kinds = (simulated(), trials(options.trials), practice(options.shared), real(options.shared))
    clean = [row for kind in (*kinds, changed(options.shared), drifted()) for row in kind]
    rows = list(faulty(options.shared))
    options.output.write_text(page(rows, clean), encoding="utf-8")


def faulty(shared: Path) -> Iterator[tuple[str, str, int, int]]:
    """Name, kind, found, tried of every fault."""
    for fault in FAULTS:
        for kind in fault.on:
            lines = []
            for names in RUNS[kind]:
                one, other = (read_recording(path_of(shared, kind, name)) for name in names)
                lines.append(told(fault.make, one, other, VALVE if kind == "valve" else BENCH))
            made = [each for each in lines if each is not None]
            row = (fault.name, kind, sum(is_found(fault, each) for each in made), len(made))
            print(*row, sep=", ", flush=True)
            yield row


def path_of(shared: Path, kind: str, name: str) -> Path:
    return shared / "practice" / name / "train.mcap" if kind == "valve" else shared / "data/xl330" / f"{name}.mcap"


def bench(model: Model, seed: int) -> Recording:
    """A minute of a simulated bench, in open loop."""
    times = np.arange(30_000) / 500.0
    return synthetic_recording(model, times, duty_sequence(times, np.random.default_rng(seed), False), seed=seed)


MACHINES = (VALVE, BENCH, PENDULUM, ROTOR)


def simulated_clean(number: int) -> tuple[str, Model, Recording]:
    """A clean recording, for each number another actuator, effect or loop, with what it is called and its description.

    One number is off by up to 1.4 and the effect one to three times as strong as is typical.
    """
    pairs: list[tuple[Model, Effect | None]] = [(machine, None) for machine in MACHINES]
    pairs += [(machine, effect) for machine in MACHINES for effect in EFFECTS if may_have(machine, effect)]
    (nominal, effect), closed = pairs[number % len(pairs)], number // len(pairs) % 2 == 1
    random = np.random.default_rng(number)
    name = str(random.choice([each for each in nominal.actuator.free if "." not in each]))
    values = {**nominal.values, name: nominal.values[name] * float(np.exp(random.uniform(-0.35, 0.35)))}
    if effect is not None:
        values |= worn(effect, values, nominal, float(random.uniform(1.0, 3.0)))
    model = nominal.with_values(in_order(values, nominal))
    made = in_loop(model, number) if closed else standard(model, number)
    return (
        f"{nominal.actuator.name}, {effect.id if effect else 'none'}, {'closed' if closed else 'open'}",
        nominal,
        made,
    )


def may_have(nominal: Model, effect: Effect) -> bool:
    return not nominal.actuator.obstacle(effect) and effect.id not in nominal.actuator.effects


def worn(effect: Effect, values: dict[str, float], nominal: Model, times: float) -> dict[str, float]:
    """An effect so many times as strong as is typical, by dotted name."""
    found = dict(effect.typical_values(values, nominal.scales))
    for name in effect.strength:
        declared, dotted = effect.parameter(name), f"{effect.id}.{name}"
        base = values[declared.above] if declared.above else 0.0
        found[dotted] = base + (found[dotted] - base) * (1.0 / times if declared.inverse else times)
    return found


def in_loop(model: Model, seed: int, samples: int = 4000) -> Recording:
    """A simulated recording in closed loop: random setpoints and a controller of three terms."""
    random, scales, actuator = np.random.default_rng(seed), model.scales, model.actuator
    step = scales.time / (100.0 if actuator.drive == "torque" else 20.0)
    largest = {"duty": 1.0, "current": scales.current, "torque": scales.torque}[actuator.input]
    stopped = np.isfinite(actuator.upper_stop)
    low, high = (actuator.lower_stop, actuator.upper_stop) if stopped else (-0.7 * scales.angle, 0.7 * scales.angle)
    wanted = np.repeat(random.uniform(low + 0.05 * (high - low), high - 0.1 * (high - low), samples // 200), 200)
    plant = Plant(model, noise=RESOLUTION * scales.reading, seed=seed)
    time, measured, command = step * np.arange(samples), np.empty(samples), np.empty(samples)
    behind = area = 0.0
    for sample in range(samples):
        measured[sample] = plant.measure()
        ahead = (decoded_value(model, measured[sample]) - behind) / 4.0
        behind += ahead
        error = (wanted[sample] - behind - 3.0 * ahead) / scales.angle
        area = float(np.clip(area + error * step / (8.0 * scales.time), -0.5, 0.5))
        damped = 0.3 * ahead / step * scales.time / scales.angle
        command[sample] = largest * np.clip(2.0 * error + area - damped, -1.0, 1.0)
        plant.advance(command[sample], step)
    setpoints = Channel(time, wanted)
    return Recording("loop", actuator.quantity, time, measured, Channel(time, command), None, None, None, setpoints,
                     input=actuator.input)  # fmt: skip


Clean = tuple[str, int, int]
"""What was held against the audit, how many, and how many of them it blamed."""


def practice(shared: Path) -> Iterator[Clean]:
    found = [
        [read_recording(folder / f"{part}.mcap") for part in ("train", "holdout")]
        for folder in sorted((shared / "practice").glob("practice-*"))
    ]
    yield blamed("practice recordings", [[each] for pair in found for each in pair], VALVE)


def real(shared: Path) -> Iterator[Clean]:
    servo = [read_recording(path) for path in sorted((shared / "data/xl330").glob("*.mcap"))]
    pendulum = [read_recording(path) for path in sorted((shared / "data/ak80").glob("*.csv"))]
    yield blamed("real XL330 servo", [[each] for each in servo], BENCH)
    yield blamed("real AK80 pendulum", [[each] for each in pendulum], PENDULUM)
    yield blamed("real ODrive rotor", [[each] for each in slow(shared / "data/odrive")], ROTOR)
    arm, hoop = shared / "data/tx40", shared / "data/ce109"
    joint, motor = (Model.nominal(read_actuator(str(path))) for path in (arm / "j4.yaml", hoop / "bh.yaml"))
    right = [
        [read(arm / f"{part}.csv", signals=arm / "sig.yaml", actuator=joint.actuator)] for part in ("train", "test")
    ]
    yield blamed("real TX40 joint", right, joint)
    runs = [[read(path, signals=hoop / "sig.yaml", actuator=motor.actuator)] for path in sorted(hoop.glob("*.csv"))]
    yield blamed("real CE109 motor and hoop", runs, motor)


def changed(shared: Path) -> Iterator[Clean]:
    """Real recordings with each effect put in that can be, as strong as is plausible and half as strong."""
    kinds = {
        "XL330 servo": ([read_recording(path) for path in sorted((shared / "data/xl330").glob("*.mcap"))], BENCH),
        "AK80 pendulum": ([read_recording(path) for path in sorted((shared / "data/ak80").glob("*.csv"))], PENDULUM),
        "ODrive rotor": (list(slow(shared / "data/odrive")), ROTOR),
    }
    for name, (recordings, model) in kinds.items():
        made = [each for recording in recordings for each in with_effects(recording, model)]
        yield blamed(f"real {name}, known effects put in", [[each] for each in made], model)


def with_effects(recording: Recording, model: Model) -> Iterator[Recording]:
    for effect in possible(model.actuator):
        plain = strongest(effect, "plain", model, ())
        for share in (1.0, 0.5):
            with suppress(CannotPutIn):
                yield with_effect(recording, effect, values_at(effect, share * plain, model), model)


def simulated() -> Iterator[Clean]:
    """Two hundred clean recordings, each against its own description."""
    wrong = 0
    for number in range(200):
        what, nominal, recording = simulated_clean(number)
        wrong += blamed(what, [[recording]], nominal)[2]
    print("simulated", 200, wrong, sep=", ", flush=True)
    yield "simulated, each effect of each actuator, open and closed loop", 200, wrong


def trials(folder: Path | None) -> Iterator[Clean]:
    """Blind trials of the valve, where there are any."""
    if folder is not None:
        found = [[read_recording(path)] for path in sorted(folder.glob("*/train.mcap"))]
        yield blamed("blind trials of the valve", found, VALVE)


def drifted() -> Iterator[Clean]:
    """Base parameters off by up to a factor of 6."""
    recordings = []
    for name in ("armature_resistance", "torque_constant", "spring_stiffness", "spring_preload", "coulomb_friction"):
        for factor in (1 / 6, 1 / 3, 1 / 2, 2.0, 3.0, 6.0):
            recordings.append([bench(VALVE.with_values({name: factor * VALVE.values[name]}), 11)])
    yield blamed("simulated, one number off by 2 to 6 either way", recordings, VALVE)


def blamed(what: str, sets: list[list[Recording]], nominal: Model) -> Clean:
    """How many of the sets of recordings the audit finds at fault."""
    wrong = 0
    for recordings in sets:
        found = audit(recordings, nominal)
        wrong += bool(found)
        for fault in found:
            print("  false alarm:", what, fault, flush=True)
    print(what, len(sets), wrong, sep=", ", flush=True)
    return what, len(sets), wrong


def page(rows: list[tuple[str, str, int, int]], clean: list[Clean]) -> str:
    """The page of docs."""
    text = HEAD.format(found=sum(row[2] for row in rows), tried=sum(row[3] for row in rows))
    found: dict[str, tuple[int, int]] = {}
    for name, _, told, tried in rows:
        before = found.get(name, (0, 0))
        found[name] = before[0] + told, before[1] + tried
    every = [name for name, (told, tried) in found.items() if told == tried]
    never = [name for name, (told, _) in found.items() if not told]
    some = [f"{name} ({told} of {tried})" for name, (told, tried) in found.items() if 0 < told < tried]
    for title, names in (("Always", every), ("Sometimes", some), ("Never", never)):
        text += f"- {title}: {'; '.join(names)}.\n"
    text += CLEAN
    return text + "".join(f"| {what} | {tried} | {wrong} |\n" for what, tried, wrong in clean)


HEAD = """\
# Signals that are not what they are read as

A wrong unit, sign, clock or signal is found before anything is searched for. The page is written by
`python benchmarks/input_faults.py --shared FOLDER --trials FOLDER`.

There is one test. Along the measured motion the motor's torque must equal load, friction and inertia. Numbers are
free within a factor of 10 and every known effect may act, but no friction drives and no shaft is beyond its stops. A
recording of which that leaves at most 5 % of the command's variation is what it is read as. Otherwise each fault of a
table is undone in turn. One is reported where less than 5 % and a fifth is left then. Where nothing mends the
recording, physics is missing: nothing is said, and the diagnosis goes on.

Where a fault is reported, `diagnose` concludes nothing: `diagnosis.json` has `input_faults`, each with the final line
of the signal map, what is written there already included. `--force` goes on. With `exact: true` in the signal map, or
`--exact duty`, a signal is not doubted, only its stamps.

## Faults that are reported

{found} of {tried}, made of practice recordings (valve) and of the XL330 (bench).

"""
CLEAN = """
What is not reported is mostly small or tied: a stamp that is late by less than the filter, a small clock error, a
scale or zero that equals a drift. No line of a signal map mends the duty of another run, one run backwards, or one
without its sign; nor are two actuators distinguished.

## Clean recordings

| recordings | n | blamed |
|---|---|---|
"""

if __name__ == "__main__":
    main()
