"""Exported models, run by what they are meant for: MuJoCo itself, and Modelica's equations by SciPy."""

import math
import re
from collections.abc import Mapping

import numpy as np
from scipy.integrate import solve_ivp

from pierburg_ros.export import export
from pierburg_ros.plant import Inputs, Model


def steps(duration: float, seed: int = 3, duties: tuple[float, float] = (-0.1, 0.5), hold: float = 0.4) -> Inputs:
    """A random duty every `hold` [s]."""
    times = np.arange(0.0, duration, hold)
    duty = np.random.default_rng(seed).uniform(*duties, times.size)
    duty[0] = 0.0
    return Inputs(times, duty)


def mujoco_angle(model: Model, inputs: Inputs, samples: np.ndarray) -> np.ndarray:
    """Angle [rad] at evenly spaced `samples` of the exported model in MuJoCo, shape (samples,); or speed [rad/s]."""
    import mujoco

    compiled = mujoco.MjModel.from_xml_string(export(model, "mujoco").text)
    data = mujoco.MjData(compiled)
    count = round((samples[1] - samples[0]) / compiled.opt.timestep)
    assert count * compiled.opt.timestep == np.float64(samples[1] - samples[0]).round(9)
    place = np.maximum(np.searchsorted(inputs.time, samples + 1e-9, side="right") - 1, 0)
    scale = model.values["supply_voltage"] if model.actuator.drive == "voltage" else 1.0
    shown = data.qvel if model.actuator.quantity == "speed" else data.qpos
    angles = np.empty(samples.size)
    for index, command in enumerate(inputs.command[place]):
        angles[index], data.ctrl[0] = shown[0], scale * command
        mujoco.mj_step(compiled, data, count)
    return angles


def modelica_output(text: str, inputs: Inputs, samples: np.ndarray) -> np.ndarray:
    """What the sensor gives at `samples`, of a Modelica text whose equations are assignments in their order."""
    constants = dict(re.findall(r"(?:parameter|constant) Real (\w+) = ([^\s;]+)", text))
    states = dict(re.findall(r"Real (\w+)\(start = ([^,]+), fixed = true", text))
    output = re.search(r"output Real (\w+)", text).group(1)
    body = re.search(r"\nequation\n(.*)\nend ", text, re.S).group(1)
    rows = [tuple(part.strip() for part in row.split(" = ", 1)) for row in body.split(";") if row.strip()]
    compiled = [(left, compile(python_of(right), left, "eval")) for left, right in rows]
    numbers: dict[str, object] = {name: float(value) for name, value in constants.items()}
    numbers |= {"max": max, "abs": abs, "exp": math.exp, "sin": math.sin, "floor": math.floor, "sign": np.sign}
    start = np.array([float(numbers.get(value, value)) for value in states.values()])

    def values(time: float, state: np.ndarray, duty: float) -> Mapping[str, float]:
        found = {**numbers, **dict(zip(states, state, strict=True)), "duty": duty, "time": time}
        for left, right in compiled:
            found[left] = eval(right, {"__builtins__": {}}, found)
        return found

    def rates(time: float, state: np.ndarray, duty: float) -> list[float]:
        found = values(time, state, duty)
        return [found[f"der({name})"] for name in states]

    measured, state, edges = [], start, np.append(inputs.time, samples[-1] + 1e-6)
    for duty, begin, end in zip(inputs.command, edges[:-1], edges[1:], strict=True):
        within = np.maximum(samples[(samples >= begin - 1e-9) & (samples < end - 1e-9)], begin)
        solved = solve_ivp(
            rates, (begin, end), state, "LSODA", np.append(within, end), args=(duty,), rtol=1e-6, atol=1e-9
        )
        measured += [values(t, y, duty)[output] for t, y in zip(within, solved.y.T, strict=False)]
        state = solved.y[:, -1]
    return np.array(measured)


def python_of(term: str) -> str:
    """A Modelica expression as Python's."""
    term = term.replace("^", "**")
    while match := re.search(r"\(if ((?:(?! if ).)*?) then ((?:(?! if ).)*?) else ([^()]*)\)", term):
        condition, this, other = match.groups()
        term = f"{term[: match.start()]}(({this}) if ({condition}) else ({other})){term[match.end() :]}"
    return term
