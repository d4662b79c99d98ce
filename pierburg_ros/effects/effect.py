"""What an effect declares: everything that anyone knows of it, but for its kernels."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal, Protocol

from pierburg_ros import parameter
from pierburg_ros.arrays import Signal
from pierburg_ros.effects.put_in import PutIn

Stage = Literal["input", "drive", "transmission", "load", "friction", "sensor"]
Drive = Literal["voltage", "current", "torque"]
Load = Literal["spring", "pendulum", "none"]
Sensor = Literal["hall_voltage", "position", "speed"]
Start = Mapping[str, float]
Quantity = Literal[
    "command_delay",
    "winding_inductance",
    "winding_heat_resistance",
    "winding_heat_capacity",
    "ripple_torque",
    "ripple_periods",
    "ripple_phase",
    "spring_cubic_stiffness",
    "contact_stiffness",
    "contact_damping",
    "viscous_damping",
    "breakaway_friction",
    "stribeck_speed",
    "bristle_stiffness",
    "bristle_damping",
]
"""What other simulators have a number for, all at the shaft and in SI units."""
Place = Literal[
    "command",
    "resistance",
    "inductance",
    "load",
    "friction_level",
    "damping",
    "bristle_stiffness",
    "bristle_damping",
    "stop_stiffness",
    "stop_damping",
    "sensed",
    "measured",
    "variable",
    "equation",
]
"""Places in the equations of the plant: `command`, `sensed` and `measured` are changed by effects, `variable` and
`equation` are further ones, and to all others effects add."""

DRIVES: tuple[Drive, ...] = ("voltage", "current", "torque")
LOADS: tuple[Load, ...] = ("spring", "pendulum", "none")
SENSORS: tuple[Sensor, ...] = ("hall_voltage", "position", "speed")
MOTORS: tuple[Drive, ...] = ("voltage", "current")
"""Drives whose torque comes from a motor with a gear."""
QUADRATURE = (0.0, math.pi / 2)
"""Phases from which a search with a free phase starts: a linear step finds any other between them."""
HIGHEST_SHARE = 0.98
"""Share of its limit up to which a search moves a parameter that has to stay `below` another: what is left is room for
the differences of a Jacobian, a thousandth of a range, on either side."""

PAPER = "Modeling and PI-Fuzzy logic controller of the Pierburg mechatronic actuator (n.d.), equation (5)"
"""The paper whose actuator the package simulates; its text names neither authors nor year."""
ARMSTRONG = (
    "Armstrong-Helouvry, Dupont, Canudas de Wit, A survey of models, analysis tools and compensation methods for the "
    "control of machines with friction (1994)"
)


class Scales(Protocol):
    """What is large for an actuator."""

    def of_unit(self, unit: str) -> float:
        """The scale of numbers with this `unit`."""


class Motion(Protocol):
    """A measured motion where the shaft moves: signals of shape (samples,), all behind one filter.

    `values` are all values of a model by dotted name.
    """

    @property
    def time(self) -> Signal:
        """[s]."""

    @property
    def angle(self) -> Signal:
        """[rad]."""

    @property
    def velocity(self) -> Signal:
        """[rad/s]."""

    @property
    def acceleration(self) -> Signal:
        """[rad/s^2]."""

    @property
    def command(self) -> Signal:
        """What drives the actuator: duty, current [A] or torque [N.m]."""

    @property
    def step(self) -> float:
        """Time between samples of the whole motion [s]."""

    @property
    def span(self) -> float:
        """Angle that the sensor spans [rad]."""

    @property
    def direction(self) -> Signal:
        """The sign of the velocity."""

    def held(self, values: Mapping[str, float]) -> Signal:
        """The torque [N.m] that friction bears where the shaft rests, positive closes."""

    def commanded(self, delay: float) -> Signal:
        """The command as it was a `delay` [s] before."""

    def of_command(self, function: Callable[[Signal], Signal]) -> Signal:
        """A function of the command, behind the filter."""

    def ripple(self, wavenumber: float) -> tuple[Signal, Signal]:
        """Sine and cosine of the angle times a `wavenumber` [1/rad], behind the filter."""

    def over_time(self, function: Callable[[Motion], Signal]) -> Signal:
        """A function of the whole motion, at the samples of this one."""

    def rate(self, function: Callable[[Motion], Signal]) -> Signal:
        """The derivative with time of a function of the whole motion, at the samples of this one."""

    def driven(self, values: Mapping[str, float], command: Signal) -> Signal:
        """The torque [N.m] at the shaft that a `command` makes of a motor at rest."""

    def current(self, values: Mapping[str, float]) -> Signal:
        """The motor's current [A]."""

    def motor_torque(self, values: Mapping[str, float]) -> Signal:
        """The motor's torque at the shaft [N.m]."""

    def braking(self, values: Mapping[str, float]) -> float:
        """What the back-EMF brakes [N.m.s/rad]."""

    def load(self, values: Mapping[str, float]) -> Signal:
        """The torque [N.m] that load, inertia and Coulomb friction need, positive closes."""

    def displaced(self, values: Mapping[str, float], shift: Signal, rate: Signal) -> Signal:
        """The load torque [N.m] that a shaft needs which is a `shift` [rad], moving by [rad/s], from the measured."""


Mark = Literal["rests", "reversals", "stops"]
"""Where an effect shows that is no torque along a motion, or not only."""


class Reach(Protocol):
    """How far recordings go, in multiples of the actuator's scales."""

    @property
    def duration(self) -> float:
        """Of the longest recording, in the actuator's own time."""

    @property
    def low(self) -> float:
        """The smallest angle."""

    @property
    def high(self) -> float:
        """The largest angle."""


@dataclass(frozen=True)
class Parameter(parameter.Parameter):
    """One number of an effect, and how a search moves it.

    What is accepted, `minimum` to `maximum`, excludes what is impossible. What is plausible and what is searched are
    multiples of the actuator's own scale of the unit: what is much for a valve is nothing for a crane.
    """

    plausible: tuple[float, float] = (0.0, 0.0)
    """Range in which a search starts, in multiples of the scale."""
    searched: tuple[float, float] | None = None
    """Range that a search does not leave, in multiples of the scale, where a value beyond would be another effect or
    none that can be told; None: many times what is plausible."""
    measure: str = ""
    """The unit whose scale is meant, if not its own: a phase is no angle of the shaft, a converter's step no supply."""
    logarithmic: bool = False
    """Searched by its logarithm."""
    above: str | None = None
    """Base parameter that it is counted from, and is never below."""
    below: str | None = None
    """Base parameter that it stays below."""
    added_to: Quantity | None = None
    """Quantity that it is added to, and may at most cancel: a negative sum would drive and not resist."""
    geared: float | None = None
    """Most that it may be times the gear ratio; None: no bound."""
    stride: float | None = None
    """Largest factor by which one linear step may scale it; None: a step does not scale it."""
    inverse: bool = False
    """A stiffness: the effect is the stronger the smaller it is, though absent at 0, which stands for rigid."""
    rhythm: bool = False
    """A frequency: known as finely as the recording is long, and moved in small steps."""
    dated: bool = False
    """Whether it tells when something happened in one recording, and not what the actuator is."""

    @property
    def moment(self) -> bool:
        """Whether it is a moment of one recording."""
        return self.dated and self.unit == "s"

    def scale(self, scales: Scales) -> float:
        """What is large for it [its unit] in an actuator with these `scales`."""
        return scales.of_unit(self.measure or self.unit)

    def expected(self, scales: Scales) -> tuple[float, float]:
        """What is plausible [its unit] in an actuator with these `scales`."""
        low, high = self.plausible
        return low * self.scale(scales), high * self.scale(scales)


@dataclass(frozen=True)
class Variant:
    """One way in which an effect may act: what is free, what is fixed, and where a search for it starts.

    `starts` are values by parameter in multiples of their scales, or what makes them of how far recordings go: as many
    as a balance can screen. A parameter that is counted from another one starts by what it exceeds that.
    """

    free: tuple[str, ...]
    starts: tuple[Start, ...] | Callable[[Reach], Sequence[Start]]
    fixed: Mapping[str, float] = field(default_factory=dict)

    def over(self, reach: Reach) -> Sequence[Start]:
        """The starts for recordings that go so far."""
        return self.starts(reach) if callable(self.starts) else self.starts


@dataclass(frozen=True)
class Ripple:
    """A sine in the load: the parameters that are its amplitude and phase."""

    amplitude: str
    phase: str


@dataclass(frozen=True)
class Elsewhere:
    """How other simulators write an effect.

    `quantities` are parameters by the name that other simulators know them by. `modelica` is what it adds to the
    equations, by the place where: `{name}` stands for a parameter of it, `{input}` for what it changes.
    """

    quantities: Mapping[Quantity, str] = field(default_factory=dict)
    modelica: Mapping[Place, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Effect:
    """One physical phenomenon; with every strength parameter at zero it is absent, bit for bit."""

    id: str
    stage: Stage
    sentence: str
    """What it does, for a person who repairs the actuator."""
    equation: str
    source: str
    """Where the equation comes from: `Authors, Title (year)`, with a place in it where that helps."""
    shows_in: str
    """Where in a recording its mark is."""
    record: str
    """What to record to see it."""
    parameters: tuple[Parameter, ...]
    strength: tuple[str, ...]
    """Parameters that make it absent where all of them are 0."""
    typical: Mapping[str, float]
    """Values as one meets them in an actuator still in service: guesses towards the lower end of what is plausible.

    They are multiples of the scales, to the digits in which the controllers' plants are told. What is left out is 0;
    what is counted from a base parameter is what exceeds it. Faults of the sensor stay below the 0.3 degree asked of a
    controller at standstill, which has nothing but this sensor and cannot correct them.
    """
    along: Callable[[Motion, Mapping[str, float]], Signal] | None = None
    """What it adds to the load torque [N.m] along a measured motion, positive closes, by all values of a model; None
    where that does not follow from the motion."""
    mark: Mark | None = None
    """Where it shows beside that, or instead."""
    at_rests: Callable[[Sequence[Motion], Mapping[str, float]], tuple[Start, float]] | None = None
    """Some of its numbers, as starts have them, read off rests of the shaft by all values of a model, and their share.

    It is that of the squared torque which friction bears there beyond what it can without the effect.
    """
    elsewhere: Elsewhere = Elsewhere()
    """How other simulators write it; by default they cannot."""
    variants: tuple[Variant, ...] = ()
    """In which ways a search looks for it; none: it is not searched for."""
    ripple: Ripple | None = None
    state: tuple[str, ...] = ()
    """Numbers that the plant's state keeps for it, `s.<id>.<name>` in the kernels, all 0 at the start."""
    linear: bool = False
    """Whether torques stay straight lines of angle and velocity between events: the simulator then takes no
    shorter steps for it."""
    drives: tuple[Drive, ...] = DRIVES
    loads: tuple[Load, ...] = LOADS
    sensors: tuple[Sensor, ...] = SENSORS
    stops: bool = False
    """Whether it needs stops to act."""
    recorded_in: str = ""
    """The signal that holds what it does where that is recorded, by its name in `plant.Inputs`."""
    turns_within: Callable[[Mapping[str, float]], float] | None = None
    """Travel [rad] within which its torque turns no more than once, from all values of a model by dotted name;
    None: its torque does not turn over the angle."""
    play: str | None = None
    """The parameter that is the width of a free play [rad]: the driven side follows when that is used up."""
    dead_time: str | None = None
    """The parameter that is a time [s] for which a command has no effect."""
    lag: str | None = None
    """The parameter that is the time constant [s] of a first-order lag of the measurement."""
    rounds: str | None = None
    """The parameter that is the step of a converter, seen in the samples and not searched for."""
    put_in: PutIn | None = None
    """Puts it into the channels of a real recording; None: that changes how the shaft moves, which no channel can be
    made to show exactly."""

    def parameter(self, name: str) -> Parameter:
        """The declaration of the parameter called `name`, without the id; KeyError where there is none."""
        return {p.name: p for p in self.parameters}[name]

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters, in the order of the declaration."""
        return tuple(p.name for p in self.parameters)

    @property
    def dated(self) -> bool:
        """Whether it acts at a time of one recording, and is not a property of the actuator."""
        return any(p.dated for p in self.parameters)

    def in_units(self, multiples: Mapping[str, float], scales: Scales) -> dict[str, float]:
        """Values in their units by name, from `multiples` of the actuator's `scales`."""
        return {name: value * self.parameter(name).scale(scales) for name, value in multiples.items()}

    def typical_values(self, base: Mapping[str, float], scales: Scales) -> dict[str, float]:
        """The typical values by dotted name, for a model with the values `base` of an actuator with these `scales`."""
        typical = self.in_units(self.typical, scales)
        return self.counted({f"{self.id}.{name}": typical.get(name, 0.0) for name in self.names}, base)

    def counted(self, values: Mapping[str, float], base: Mapping[str, float]) -> dict[str, float]:
        """`values` by dotted name with what is counted from a base parameter added to its value in `base`."""
        above = {f"{self.id}.{p.name}": p.above for p in self.parameters if p.above is not None}
        return {name: value + (base[above[name]] if name in above else 0.0) for name, value in values.items()}

    def acts(self, values: Mapping[str, float]) -> bool:
        """Whether it acts in a model with these `values`, by dotted name."""
        return any(map(values.__getitem__, self._strengths))

    @cached_property
    def _strengths(self) -> tuple[str, ...]:
        """Dotted names of what is its strength."""
        return tuple(f"{self.id}.{name}" for name in self.strength)

    def obstacle(self, drive: Drive, load: Load, sensor: Sensor, stops: bool) -> str:
        """Why it cannot act in an actuator of this kind, in words; nothing where it can."""
        for what, has, needed in (
            ("drive", drive, self.drives),
            ("load", load, self.loads),
            ("sensor", sensor, self.sensors),
        ):
            if has not in needed:
                own = f"no {what}" if has == "none" else f"a {has} {what}"
                return f"it needs a {' or '.join(needed)} {what}, and the actuator has {own}".replace("_", " ")
        return "it needs stops, and the actuator has none" if self.stops and not stops else ""


def grid(**values: tuple[float, ...]) -> tuple[Start, ...]:
    """Every combination of starting `values`, multiples of their scales."""
    starts: list[dict[str, float]] = [{}]
    for name, several in values.items():
        starts = [{**start, name: value} for start in starts for value in several]
    return tuple(starts)
