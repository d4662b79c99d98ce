"""Figures 3 to 5: the static characteristic, steps of duty, resistance in series."""

from __future__ import annotations

import numpy as np
from drawing import Numbers, empty_figure, save

from pierburg_ros.identification.experiment.excitation import duty_sequence
from pierburg_ros.identification.experiment.synthetic import synthetic_recording
from pierburg_ros.identification.paper.lumps import duties, lumps
from pierburg_ros.identification.paper.static_characteristic import static_characteristic
from pierburg_ros.identification.paper.table_one import PRINTED, derive
from pierburg_ros.identification.plot import draw_static
from pierburg_ros.plant import Inputs, Model, simulate

TIME = np.arange(3501) / 500.0
STEP = 0.5
"""Time of the step of duty [s]."""
COLOURS = ("#d62728", "#2ca02c", "#1f77b4")
SERIES = (1.0, 1.17, 1.42)
"""Total resistance over that of the motor, in the paper's Figs. 9 to 11."""


def draw(model: Model) -> Numbers:
    """Draw the three figures."""
    return {**static(model), **steps(model), **resistance(model)}


def angle_after_step(model: Model, duty: float) -> np.ndarray:
    """Angle [degrees] at TIME, after a step of duty from rest."""
    volts = simulate(model, Inputs(np.array([0.0, STEP]), np.array([0.0, duty])), TIME)
    closed, opened = model.values["hall_voltage_closed"], model.values["hall_voltage_open"]
    return np.asarray(90.0 * (volts - closed) / (opened - closed))


def static(model: Model) -> Numbers:
    """Fig. 3."""
    time = np.arange(75_000) / 500.0
    recording = synthetic_recording(model, time, duty_sequence("staircase", model, time))
    found = static_characteristic([recording], model.actuator)
    assert found is not None
    figure = empty_figure()
    draw_static(figure, found, model.actuator.upper_stop, "simulated staircase, 3 mV noise")
    save(figure, 3)
    shown = {"D_c": found.coulomb_duty.value, "D_pre": found.preload_duty.value}
    theory = {f"{name}_theory": duty for name, duty in duties(model).items()}
    return {name: f"{100.0 * duty:.3f}" for name, duty in {**shown, **theory}.items()}


def steps(model: Model) -> Numbers:
    """Fig. 4."""
    found, supply = derive(model), model.values["supply_voltage"]
    possible = [model.with_values({"supply_voltage": v}) for v in (found.supply_low, found.supply_high)]
    figure = empty_figure()
    axes = figure.subplots()
    ends = []
    for duty, colour in zip((0.24, 0.22, 0.20), COLOURS, strict=True):
        angle = angle_after_step(model, duty)
        low, high = (angle_after_step(each, duty) for each in possible)
        axes.plot(TIME, angle, color=colour, label=f"0 to {duty:.0%}")
        axes.fill_between(TIME, low, high, color=colour, alpha=0.12, linewidth=0)
        ends.append(f"{duty:.0%} to {angle[-1]:.1f} degrees ({low[-1]:.1f} to {high[-1]:.1f})")
    axes.set(xlabel="time [s]", ylabel="angle [degrees]")
    axes.set_title(f"line: {supply:g} V, shaded: {found.supply_low:.3f} to {found.supply_high:.2f} V")
    axes.legend(fontsize=8)
    save(figure, 4)
    moving = 0.24 * supply - found.coulomb_voltage - found.preload_voltage
    return {
        "supply": f"{supply:g}",
        "supply_low": f"{found.supply_low:.3f}",
        "supply_high": f"{found.supply_high:.2f}",
        "step_ends": "; ".join(ends),
        "time_constant": f"{lumps(model)['time_constant']:.3f}",
        "step_end_printed_gain": f"{np.degrees(PRINTED['gain'] * moving):.1f}",
    }


def resistance(model: Model) -> Numbers:
    """Fig. 5."""
    figure = empty_figure()
    axes = figure.subplots()
    ends = []
    for factor, colour in zip(SERIES, COLOURS, strict=True):
        total = factor * model.values["armature_resistance"]
        for duty, style in ((0.24, "-"), (0.30, "--")):
            angle = angle_after_step(model.with_values({"armature_resistance": total}), duty)
            label = f"{factor:g} R, {duty:.0%}"
            axes.plot(TIME, angle, style, color=colour, label=label)
            ends.append(f"{label}: {angle[-1]:.1f} degrees")
    axes.set(xlabel="time [s]", ylabel="angle [degrees]")
    axes.legend(fontsize=8)
    save(figure, 5)
    return {"series_ends": "; ".join(ends)}
