"""Simulated measurements: an actuator driven by a duty, or by the controller."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.actuators import Actuator
from pierburg_ros.closed_loop import simulate_loop
from pierburg_ros.closed_loop.open_loop import simulate_measurement
from pierburg_ros.control import Schedule, Settings, read_duty_file, read_parameter_file, read_setpoint_file
from pierburg_ros.control.schedule import read_schedule
from pierburg_ros.control.setpoints import STOP_TOLERANCE, Setpoints
from pierburg_ros.errors import InputError
from pierburg_ros.inference.data import inputs_of
from pierburg_ros.intake import check_count, check_magnitude
from pierburg_ros.intake.bounds import LARGEST
from pierburg_ros.library.model import Model, ModelLike, chosen_model
from pierburg_ros.library.reading import read
from pierburg_ros.library.recording import Recording
from pierburg_ros.library.result import Result
from pierburg_ros.library.tables import data_frame
from pierburg_ros.library.topics import topics_of
from pierburg_ros.parameter import Parameter
from pierburg_ros.plant import Inputs
from pierburg_ros.recording import Channel, write_recording
from pierburg_ros.recording.read import SPARSEST

if TYPE_CHECKING:
    import pandas
    import plotly.graph_objects as go
    from matplotlib.figure import Figure

FILE = "simulated.mcap"
RATE = 500.0
"""Samples a second [Hz] where neither an option nor the input says; the rate of the valve's control loop."""
AFTER_LAST = 2.0
"""How long the last row of a file holds unless a duration is given [s]: two time constants of the valve."""
SAMPLED = (
    Parameter("duration", None, "length", "s", 0.01, 1e5),
    Parameter("rate", None, "samples a second", "Hz", 1.0 / SPARSEST, 1e5),
    Parameter("noise", None, "RMS, in the measured unit", "", 0.0, LARGEST),
    Parameter("seed", 0, "of the noise", "", 0, 2**63),
)
"""What may be asked of a run: at least what is read again as a recording, at most what the command takes."""
Signal: TypeAlias = NDArray[np.float64]
Values: TypeAlias = Sequence[float] | Signal
Drive: TypeAlias = Recording | Values | str | Path


@dataclass(frozen=True)
class Sampling:
    """When and how the sensor is read, and where the shaft starts."""

    duration: float | None = None
    """[s]; None: as long as the input."""
    rate: float | None = None
    """[Hz]; None: 500, or as the input was sampled."""
    noise: float = 0.0
    """RMS, in the measured unit."""
    seed: int = 0
    initial_angle: float = 0.0
    """[rad]"""

    def __post_init__(self) -> None:
        for each in SAMPLED:
            if (given := getattr(self, each.name)) is not getattr(Sampling, each.name):
                object.__setattr__(self, each.name, each.accepted(given))

    def start(self, actuator: Actuator) -> float:
        """The initial angle [rad], which is 0 or between the stops; InputError where it is neither."""
        low, high = min(actuator.lower_stop, 0.0), max(actuator.upper_stop, 0.0)
        ends = low - STOP_TOLERANCE, high + STOP_TOLERANCE
        Parameter("initial_angle", None, "", actuator.shown("rad"), *ends).accepted(self.initial_angle)
        return self.initial_angle

    def times(self, last: float) -> Signal:
        """Sample times [s], evenly spaced, by default until `last`."""
        rate, duration = self.rate or RATE, self.duration or last
        check_count(duration, rate, "A simulation")
        return np.arange(round(duration * rate) + 1) / rate

    def times_like(self, sampled: Signal) -> Signal:
        """The times [s] at which something was `sampled`, unless a rate or a duration beyond its end is wanted."""
        longer = self.duration is not None and self.duration > sampled[-1]
        if self.rate is not None or longer:
            return self.times(float(sampled[-1]))
        return sampled[sampled <= (self.duration or sampled[-1])]


@dataclass(frozen=True, repr=False, eq=False)
class Simulation(Result):
    """What the sensor of a simulated actuator gave, as a recording, and the model behind it."""

    model: Model
    recording: Recording

    @property
    def time(self) -> Signal:
        """Sample times [s], shape (samples,)."""
        return self.recording.time

    @property
    def measured(self) -> Signal:
        """Hall voltage [V], position [rad] or speed [rad/s] at each time, shape (samples,)."""
        return self.recording.measured

    @property
    def unit(self) -> str:
        """Unit of the measured quantity."""
        return self.model.actuator.shown(self.recording.unit)

    @property
    def command(self) -> Signal:
        """Duty [1], current [A] or torque [N.m] in force at each time, shape (samples,)."""
        return self.recording.command.at(self.recording.time, before=0.0)

    @property
    def title(self) -> str:
        """Actuator and effects."""
        return " with ".join([self.model.actuator.name, *filter(None, [", ".join(self.model.active_effects)])])

    def to_json(self) -> str:
        """Every sample as JSON: time [s], the input, and what is measured."""
        columns = {name: values.tolist() for name, values in self.columns().items()}
        about = {"schema": 1, "model": self.model.as_mapping(), "quantity": self.recording.quantity}
        return json.dumps({**about, "unit": self.unit, **columns}, allow_nan=False) + "\n"

    def figure(self) -> go.Figure:
        """Measured quantity and input over time, as a Plotly figure."""
        from pierburg_ros.library.signal_plot import figure

        return figure(self.recording, self.unit, self.model.actuator.motion, self.title)

    def picture(self) -> Figure:
        """The same as a Matplotlib figure."""
        from pierburg_ros.library.signal_plot import picture

        return picture(self.recording, self.unit, self.model.actuator.motion, self.title)

    def columns(self) -> dict[str, Signal]:
        """Time [s], the input in force and what is measured, each of shape (samples,)."""
        return {"time": self.time, self.recording.input: self.command, self.recording.quantity: self.measured}

    def table(self) -> pandas.DataFrame:
        """One row a sample: time [s], duty [1] (or current, torque) in force, hall_voltage [V] (or position, speed)."""
        return data_frame(self.columns())

    def rows(self) -> dict[str, str]:
        """Length, rate and range."""
        low, high = float(self.measured.min()), float(self.measured.max())
        return {
            "simulated": f"{self.recording.duration:.2f} s, {self.time.size} samples",
            self.recording.quantity.replace("_", " "): f"{low:.4g} to {high:.4g} {self.unit}",
        }

    def write_into(self, folder: Path) -> None:
        """Write simulated.mcap."""
        write_recording(folder / FILE, topics_of(self.recording))


def simulate(
    model: ModelLike,
    *,
    duty: Drive | None = None,
    setpoints: Values | str | Path | None = None,
    time: Values | None = None,
    controller: Settings | str | Path | None = None,
    duration: float | None = None,
    rate: float | None = None,
    noise: float = 0.0,
    seed: int = 0,
    initial_angle: float = 0.0,
) -> Simulation:
    """The actuator of `model` under a duty (open loop) or under the controller (closed loop).

    `duty` [1, from -1 to 1; current in A or torque in N.m where the actuator is driven by one] or `setpoints` [rad]
    are values of shape (changes,) that each hold from their `time` [s] until the next one; or a file, a CSV with the
    header `time,duty` or `time,setpoint`; or, for the duty, a recording or its path. `controller`: settings, or their
    parameter file. `duration` [s] and `rate` [Hz] of the
    samples; by default those of the input, or 500 Hz. `noise` is its RMS in the measured unit, drawn by `seed`;
    `initial_angle` [rad]. InputError where the input or the model cannot be used.

        time = np.arange(0.0, 3.0, 0.002)
        simulation = pr.simulate(pr.Model.nominal(), duty=np.where(time < 0.5, 0.0, 0.24), time=time)
    """
    if (duty is None) == (setpoints is None):
        raise InputError("Expected either a duty (open loop) or setpoints (closed loop). Give one of them.")
    if time is not None and isinstance(duty if setpoints is None else setpoints, (str, Path, Recording)):
        raise InputError("Found a time beside a file or a recording, which has its own. Leave the time out.")
    if duty is not None and controller is not None:
        raise InputError("Found a controller with a duty, which runs without one. Leave the controller out.")
    chosen = chosen_model(model)
    sampling = Sampling(duration, rate, noise, seed, initial_angle)
    if duty is not None:
        return Simulation(chosen, open_loop(chosen, duty, time, sampling))
    assert setpoints is not None
    settings = Settings() if controller is None else controller
    if isinstance(settings, (str, Path)):
        settings = read_parameter_file(settings)
    if not isinstance(settings, Settings):
        raise InputError(f"Found a controller of type {type(settings).__name__}, expected settings. Give their file.")
    return Simulation(chosen, closed_loop(chosen, settings, scheduled(setpoints, time), sampling))


def closed_loop(model: Model, settings: Settings, setpoints: Schedule, sampling: Sampling) -> Recording:
    """A run under the controller."""
    duration = sampling.duration or float(setpoints.time[-1]) + AFTER_LAST
    rate = sampling.rate or RATE
    check_count(duration, rate, "A simulation")
    limits = Setpoints(settings.angle_closed, settings.angle_open, settings.angle_closed)
    wanted = Schedule(setpoints.time, np.array([limits.accepted(each) for each in setpoints.values.tolist()]))
    start = sampling.start(model.actuator)
    run = simulate_loop(model, settings, wanted, duration, rate, sampling.noise, sampling.seed, start)
    given = until(Channel(wanted.time, wanted.values), run.time[-1])
    return Recording(FILE, "hall_voltage", run.time, run.hall_voltage, Channel(run.time, run.duty), setpoints=given)


def open_loop(model: Model, duty: Drive, time: Values | None, sampling: Sampling) -> Recording:
    """A run under a duty: one written down, or one recorded."""
    supply: Channel | None = None
    enabled: Channel | None = None
    if isinstance(duty, (str, Path)) and is_duty_file(Path(duty)):
        schedule = read_duty_file(duty) if model.actuator.input == "duty" else read_input_file(duty, model)
        inputs, channel = Inputs(schedule.time, schedule.values), Channel(schedule.time, schedule.values)
        times = sampling.times(float(schedule.time[-1]) + AFTER_LAST)
    elif isinstance(duty, (str, Path, Recording)):
        recorded = duty if isinstance(duty, Recording) else read(duty, actuator=model.actuator)
        if recorded.input != model.actuator.input:
            raise InputError(
                f"{recorded.name} holds a {recorded.input} and actuator {model.actuator.name} is driven by a"
                f" {model.actuator.input}; expected a recorded {model.actuator.input}."
            )
        inputs, channel = inputs_of(recorded), recorded.command
        supply, enabled = recorded.supply_voltage, recorded.enabled
        times = sampling.times_like(recorded.time)
    else:
        when = changes(time)
        inputs = Inputs(when, numbers(model.actuator.input, duty))
        channel = Channel(inputs.time, inputs.command)
        times = sampling.times_like(when)
    start = sampling.start(model.actuator)
    measured = simulate_measurement(model, inputs, times, sampling.noise, sampling.seed, start)
    last = float(times[-1])
    supply, enabled = (each and until(each, last) for each in (supply, enabled))
    held, driven_by = until(channel, last), model.actuator.input
    return Recording(FILE, model.actuator.quantity, times, measured, held, supply, enabled=enabled, input=driven_by)


def read_input_file(path: str | Path, model: Model) -> Schedule:
    """The currents [A] or torques [N.m] in a CSV with the header `time,current` or `time,torque`."""
    return read_schedule(path, model.actuator.input, finite)


def finite(value: float) -> float:
    """The value itself; InputError where it is no finite number."""
    if not np.isfinite(value):
        raise InputError(f"{value} is not finite; give a number.")
    return value


def scheduled(setpoints: Values | str | Path, time: Values | None) -> Schedule:
    """Setpoints [rad] from a file, or the values given with their times."""
    if isinstance(setpoints, (str, Path)):
        return read_setpoint_file(setpoints)
    when, values = changes(time), numbers("setpoints", setpoints)
    if when.shape != values.shape:
        raise InputError(f"Found {when.size} times and {values.size} setpoints, expected one time for each.")
    return Schedule(when, values)


def changes(time: Values | None) -> Signal:
    """Times [s] of values, rising; InputError where there are none."""
    if time is None:
        raise InputError("Found values without their times, expected one time [s] for each. Give time too.")
    when = numbers("time", time)
    if when.ndim != 1 or when.size < 2 or not np.all(np.diff(when) > 0):
        raise InputError(f"Found times of shape {when.shape}, expected two or more, each after the one before.")
    return when


def numbers(what: str, given: Any) -> Signal:
    """Real numbers as an array; InputError where they are others, as dates are, or where one is masked or too large."""
    kind = np.asarray(given).dtype
    if kind.kind not in "biuf" or np.ma.is_masked(given):
        found = "masked values" if np.ma.is_masked(given) else kind
        raise InputError(
            f"Found {what} as {found}, expected real numbers, none missing. Convert them, times to seconds."
        )
    values = np.asarray(given, dtype=float)
    check_magnitude(what, values.ravel())
    return values


def until(channel: Channel, last: float) -> Channel:
    """What acts up to the time `last` [s]."""
    within = channel.time <= last + 1e-9  # times of samples are rounded
    return Channel(channel.time[within], channel.values[within])


def is_duty_file(path: Path) -> bool:
    """Whether `path` is a CSV of time and duty alone, not of a recording."""
    if path.suffix.lower() != ".csv" or not path.is_file():
        return False
    with path.open(encoding="utf-8", errors="replace") as file:
        header = file.readline()
    return not any(measured in header for measured in ("hall_voltage", "position", "speed"))
