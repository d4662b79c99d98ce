"""The valve a third time: every torque a plain function, integrated by SciPy's LSODA from event to event.

State of the differential equation: angle [rad], velocity [rad/s], current [A], temperature rise [K], bristle [rad].
A test that checks an effect writes the effect's equation into a `Valve` and compares.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp

PRELOAD, STIFFNESS, COULOMB = 0.29, 0.1419, 0.2007  # N.m, N.m/rad, N.m: Table I
SUPPLY = 13.5  # V


def spring(time: float, angle: float, velocity: float) -> float:
    """Return spring [N.m]."""
    return PRELOAD + STIFFNESS * angle


def coulomb(angle: float, velocity: float, direction: float, motor: float) -> float:
    """Constant friction level [N.m]."""
    return COULOMB


@dataclass(frozen=True)
class Valve:
    """Table I and the equations that an effect may replace."""

    load: Callable[[float, float, float], float] = spring
    level: Callable[[float, float, float, float], float] = coulomb
    viscous: Callable[[float], float] = lambda direction: 0.0
    effective: Callable[[float], float] = lambda duty: duty
    source_resistance: float = 0.0
    inductance: float = 0.0
    thermal_resistance: float = 0.0
    heat_capacity: float = 1.0
    bristle_stiffness: float = 0.0
    bristle_damping: float = 0.0
    stops: tuple[float, float] = (0.0, math.pi / 2)
    resistance: float = 4.139
    constant: float = 37.3 * 0.022
    inertia: float = 2.4602e-6

    def circuit(self, duty: float, rise: float) -> float:
        """Resistance of the motor circuit [ohm]."""
        return self.resistance * (1.0 + 0.0039 * rise) + self.source_resistance * duty**2

    def current(self, duty: float, velocity: float, state: np.ndarray) -> float:
        """Armature current [A]."""
        if self.inductance:
            return float(state[2])
        return (self.effective(duty) * SUPPLY - self.constant * velocity) / self.circuit(self.effective(duty), state[3])

    def push(self, time: float, state: np.ndarray, duty: float, velocity: float) -> tuple[float, float]:
        """Motor torque, and what is left of it after the loads [N.m]."""
        motor = self.constant * self.current(duty, velocity, state)
        return motor, motor - self.load(time, state[0], velocity)

    def friction(self, state: np.ndarray, velocity: float, direction: float, motor: float) -> tuple[float, float]:
        """Friction torque while sliding [N.m], and the velocity of the bristle [rad/s]."""
        level = self.level(state[0], velocity, direction, motor)
        viscous = self.viscous(direction) * velocity
        if not self.bristle_stiffness:
            return direction * level + viscous, 0.0
        moving = velocity - abs(velocity) * state[4] * self.bristle_stiffness / level
        return self.bristle_stiffness * state[4] + self.bristle_damping * moving + viscous, moving

    def derivative(self, time: float, state: np.ndarray, duty: float, direction: float) -> list[float]:
        """Time derivative of the state, sliding in `direction`, or held where that is 0."""
        velocity = float(state[1]) if direction else 0.0
        motor, net = self.push(time, state, duty, velocity)
        amperes = motor / self.constant
        acceleration = bristle = 0.0
        if direction:
            friction, bristle = self.friction(state, velocity, direction, motor)
            acceleration = (net - friction) / self.inertia
        inductive = heating = 0.0
        if self.inductance:
            drop = self.circuit(self.effective(duty), state[3]) * amperes + self.constant * velocity
            inductive = (self.effective(duty) * SUPPLY - drop) / self.inductance
        if self.thermal_resistance:
            hot = self.resistance * (1.0 + 0.0039 * state[3])
            heating = (amperes**2 * hot - state[3] / self.thermal_resistance) / self.heat_capacity
        return [velocity, acceleration, inductive, heating, bristle]

    def excess(self, time: float, state: np.ndarray, duty: float) -> tuple[float, float]:
        """By how much the push on the standing shaft exceeds what holds it, opening and closing [N.m]."""
        motor, net = self.push(time, state, duty, 0.0)
        if self.bristle_stiffness:
            net -= self.bristle_stiffness * state[4]
            return net, -net
        return net - self.level(state[0], 0.0, 1.0, motor), -net - self.level(state[0], 0.0, -1.0, motor)


def trajectory(valve: Valve, time: np.ndarray, duty: np.ndarray, samples: np.ndarray, start: float = 0.0) -> np.ndarray:
    """Shaft angle [rad] at `samples` [s]; `duty` holds from each `time` [s] on, the valve starts at rest."""
    changes = np.flatnonzero(np.diff(duty)) + 1
    edges = np.concatenate([[time[0]], time[changes], [samples[-1]]])
    acting = np.concatenate([[duty[0]], duty[changes]])
    state = np.array([start, 0.0, 0.0, 0.0, 0.0])
    if valve.bristle_stiffness and start <= valve.stops[0]:
        state[4] = -COULOMB / valve.bristle_stiffness
    angles = np.empty(samples.size)
    direction = 0.0
    for begin, end, value in zip(edges[:-1], edges[1:], acting, strict=True):
        wanted = samples[(samples >= begin) & (samples <= end)]
        found, state, direction = _interval(valve, value, begin, end, wanted, state, direction)
        angles[(samples >= begin) & (samples <= end)] = found
    return angles


def _interval(
    valve: Valve, duty: float, begin: float, end: float, wanted: np.ndarray, state: np.ndarray, direction: float
) -> tuple[np.ndarray, np.ndarray, float]:
    """One interval of constant duty: angles at `wanted`, final state and direction."""
    found = np.full(wanted.size, state[0])
    now = begin
    while now < end:
        if direction == 0.0:
            direction = _onset(valve, now, state, duty)
        solution = solve_ivp(
            valve.derivative, (now, end), state, "LSODA", args=(duty, direction), dense_output=True,
            events=_events(valve, direction), rtol=1e-8, atol=[1e-9, 1e-7, 1e-8, 1e-7, 1e-10], max_step=0.05,
        )  # fmt: skip
        covered = (wanted >= now) & (wanted <= solution.t[-1])
        if covered.any():
            found[covered] = solution.sol(wanted[covered])[0]
        state, now = solution.y[:, -1].copy(), solution.t[-1]
        if solution.status == 1:
            direction = _after(valve, now, state, duty, direction, stopped=solution.t_events[-1].size > 0)
            found[wanted >= now] = state[0]
    return found, state, direction


def _after(valve: Valve, now: float, state: np.ndarray, duty: float, direction: float, stopped: bool) -> float:
    """Direction after an event: loose, at rest, or at a stop, where the velocity is lost."""
    if direction == 0.0:
        opening, closing = valve.excess(now, state, duty)
        return 1.0 if opening > closing else -1.0
    state[1] = 0.0
    if stopped:
        state[0] = valve.stops[1] if direction > 0 else valve.stops[0]
    return 0.0


def _onset(valve: Valve, now: float, state: np.ndarray, duty: float) -> float:
    opening, closing = valve.excess(now, state, duty)
    if opening > 0.0 and state[0] < valve.stops[1]:
        return 1.0
    if closing > 0.0 and state[0] > valve.stops[0]:
        return -1.0
    return 0.0


def _events(valve: Valve, direction: float) -> list[Callable[..., float]]:
    """While sliding: rest, then a stop. While held: breaking loose."""

    def rest(time: float, state: np.ndarray, duty: float, direction: float) -> float:
        return float(state[1]) * direction

    def stop(time: float, state: np.ndarray, duty: float, direction: float) -> float:
        return float((valve.stops[1] - state[0]) if direction > 0 else (state[0] - valve.stops[0]))

    def loose(time: float, state: np.ndarray, duty: float, direction: float) -> float:
        opening, closing = valve.excess(time, state, duty)
        blocked = -1.0
        opening = opening if state[0] < valve.stops[1] else blocked
        closing = closing if state[0] > valve.stops[0] else blocked
        return max(opening, closing)

    for event, crossing in ((rest, -1.0), (stop, -1.0), (loose, 1.0)):
        event.terminal, event.direction = True, crossing  # type: ignore[attr-defined]
    return [rest, stop] if direction else [loose]
