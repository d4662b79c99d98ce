"""The nominal valve as other simulators do it: SciPy's LSODA with events, LSODA with smoothed friction, MuJoCo.

Each takes the inputs and sample times of `simulate` and gives the Hall voltage. Values are those of Table I.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from scipy.integrate import solve_ivp

from pierburg_ros.plant import Inputs

Simulator = Callable[[Inputs, np.ndarray], np.ndarray]

RESISTANCE, CONSTANT, SUPPLY = 4.139, 37.3 * 0.022, 13.5  # ohm, N.m/A at the shaft, V
PRELOAD, STIFFNESS, COULOMB, INERTIA = 0.29, 0.1419, 0.2007, 2.4602e-6  # N.m, N.m/rad, N.m, kg.m2
OPEN = math.pi / 2
DAMPING = CONSTANT**2 / RESISTANCE  # N.m.s/rad, of the induced voltage
HARD = 0.9999  # of MuJoCo's constraints; its default, 0.9 to 0.95, lets so light a shaft through friction and stops
SMOOTHING = 0.01  # rad/s, width of tanh where the friction is smoothed


def hall(angle: np.ndarray) -> np.ndarray:
    """Hall voltage [V] of an angle [rad]."""
    return 0.42 + 4.1 * angle / OPEN


def available() -> dict[str, tuple[Simulator, int]]:
    """The peers that are installed, each with how often it is timed."""
    found: dict[str, tuple[Simulator, int]] = {
        "SciPy LSODA, stick, slip and stops as events": (lsoda_with_events, 5),
        "SciPy LSODA, friction smoothed by tanh": (lsoda_smoothed, 3),
    }
    try:
        import mujoco  # noqa: F401
    except ImportError:
        print("MuJoCo is not installed and is left out; pip install mujoco")
    else:
        found["MuJoCo, implicitfast, 1 ms"] = (mujoco_steps, 3)
        found["MuJoCo, implicitfast, 0.1 ms"] = (lambda inputs, times: mujoco_steps(inputs, times, 1e-4), 1)
    return found


def creep(run: Simulator) -> float:
    """How fast [rad/s] the shaft creeps while friction should hold it: opened, then 10 s at a duty inside the band."""
    inputs = Inputs(np.array([0.0, 1.0]), np.array([0.30, 0.22]))
    times = np.arange(11000) / 1000.0
    voltage = run(inputs, times)
    return abs(float(voltage[-1] - voltage[1500])) / 4.1 * OPEN / (times[-1] - times[1500])


def _pieces(inputs: Inputs, times: np.ndarray) -> list[tuple[float, float, float]]:
    """Begin, end [s] and armature voltage [V] of each interval of constant duty."""
    edges = np.append(inputs.time, times[-1])
    return [
        (float(a), float(b), SUPPLY * float(d)) for a, b, d in zip(edges[:-1], edges[1:], inputs.command, strict=True)
    ]


def lsoda_with_events(inputs: Inputs, times: np.ndarray) -> np.ndarray:
    """Slip integrated from event to event; a held shaft is not integrated at all."""
    angles = np.zeros(times.size)
    angle = velocity = 0.0
    for begin, end, volts in _pieces(inputs, times):
        now, drive = begin, CONSTANT * volts / RESISTANCE
        while now < end:
            net = drive - PRELOAD - STIFFNESS * angle
            way = math.copysign(1.0, velocity) if velocity else math.copysign(1.0, net) if abs(net) > COULOMB else 0.0
            if way == 0.0 or (velocity == 0.0 and ((way > 0 and angle >= OPEN) or (way < 0 and angle <= 0.0))):
                angles[(times >= now) & (times <= end)] = angle
                break

            def slope(t: float, state: np.ndarray, drive: float = drive, way: float = way) -> tuple[float, float]:
                rest = drive - DAMPING * state[1] - PRELOAD - STIFFNESS * state[0] - way * COULOMB
                return state[1], rest / INERTIA

            def stands(t: float, state: np.ndarray, way: float = way) -> float:
                return float(state[1]) * way

            def stops(t: float, state: np.ndarray, way: float = way) -> float:
                return float(OPEN - state[0] if way > 0 else state[0])

            for event in (stands, stops):
                event.terminal, event.direction = True, -1.0  # type: ignore[attr-defined]
            marks = np.append(times[(times >= now) & (times < end)], end)
            solution = solve_ivp(
                slope, (now, end), (angle, velocity), "LSODA", t_eval=marks, events=[stands, stops],
                rtol=1e-6, atol=1e-8,
            )  # fmt: skip
            first, reached = int(np.searchsorted(times, now)), min(len(solution.t), marks.size - 1)
            if reached:
                angles[first : first + reached] = solution.y[0][:reached]
            if solution.status == 0:
                angle, velocity, now = float(solution.y[0, -1]), float(solution.y[1, -1]), end
                continue
            hit = solution.t_events[1].size > 0
            which = 1 if hit else 0
            now, angle, velocity = float(solution.t_events[which][0]), float(solution.y_events[which][0][0]), 0.0
            if hit:
                angle = OPEN if way > 0 else 0.0
    angles[-1] = angle
    return hall(angles)


def lsoda_smoothed(inputs: Inputs, times: np.ndarray) -> np.ndarray:
    """Friction as tanh of the velocity, stops as stiff springs; one interval of constant duty after another."""
    state = np.zeros(2)
    angles = np.zeros(times.size)
    for begin, end, volts in _pieces(inputs, times):
        drive = CONSTANT * volts / RESISTANCE

        def slope(t: float, state: np.ndarray, drive: float = drive) -> tuple[float, float]:
            angle, velocity = state
            stop = 1e3 * (min(angle, 0.0) + max(angle - OPEN, 0.0))
            rest = drive - DAMPING * velocity - PRELOAD - STIFFNESS * angle - COULOMB * math.tanh(velocity / SMOOTHING)
            return velocity, (rest - stop) / INERTIA

        inside = times[(times >= begin) & (times < end)]
        marks = np.append(inside, end) if inside.size == 0 or inside[-1] < end else inside
        solution = solve_ivp(slope, (begin, end), state, "LSODA", t_eval=marks, rtol=1e-6, atol=1e-8)
        angles[(times >= begin) & (times < end)] = solution.y[0, : inside.size]
        state = solution.y[:, -1]
    angles[-1] = state[0]
    return hall(angles)


def mujoco_steps(inputs: Inputs, times: np.ndarray, step: float = 1e-3) -> np.ndarray:
    """A hinge with armature, damping, friction loss, spring and range; the motor's torque applied at each step."""
    import mujoco

    model = mujoco.MjModel.from_xml_string(f"""
        <mujoco>
          <option timestep="{step}" integrator="implicitfast" gravity="0 0 0"/>
          <worldbody><body>
            <joint name="shaft" type="hinge" axis="0 0 1" limited="true" range="0 {math.degrees(OPEN)}"
              armature="{INERTIA}" damping="{DAMPING}" frictionloss="{COULOMB}" stiffness="{STIFFNESS}"
              solimpfriction="{HARD} {HARD} 0.001" solimplimit="{HARD} {HARD} 0.001"/>
            <inertial pos="0 0 0" mass="1e-6" diaginertia="1e-9 1e-9 1e-9"/>
          </body></worldbody>
        </mujoco>""")
    data = mujoco.MjData(model)
    every = round(float(times[1] - times[0]) / step)
    duty = np.append(0.0, inputs.command)[np.searchsorted(inputs.time, times, side="right")]
    torque = CONSTANT * SUPPLY * duty / RESISTANCE - PRELOAD
    angles = np.empty(times.size)
    for sample, push in enumerate(torque):
        angles[sample] = data.qpos[0]
        data.qfrc_applied[0] = push
        mujoco.mj_step(model, data, every)
    return hall(angles)
