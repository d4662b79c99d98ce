"""A diagnosis with every part, and what its page shows beside it, without any search."""

from dataclasses import replace

import numpy as np

from pierburg_ros.actuators import read_actuator
from pierburg_ros.diagnosis.result import Characteristic, Exhibits, Points, Result, Tried, View
from pierburg_ros.diagnosis.schema import (
    BaseParameter,
    Candidate,
    Change,
    DataQuality,
    Diagnosis,
    Effect,
    Errors,
    Estimate,
    Excluded,
    FitQuality,
    Horizon,
    Location,
    NotTestable,
    Regime,
    Remaining,
    ResidualTorque,
    RuledOut,
    TorqueOverTime,
)
from pierburg_ros.plant import Model

TIME = 0.002 * np.arange(30000)


def diagnosis(**changes) -> Diagnosis:
    errors = Errors(nominal_rmse=0.2, recalibrated_rmse=0.07, final_rmse=0.0042)
    horizons = [Horizon(after=after, **errors.model_dump()) for after in (0.1, 3.0, None)]
    breakaway = Estimate(value=0.27, unit="N.m", ci95=(0.26, 0.28), identifiable=True)
    preload = BaseParameter(nominal=0.29, value=0.33, unit="N.m", ci95=None, identifiable=True, drifted=True)
    fields = {
        "recordings": ["train<1>.mcap"],
        "quantity": "hall_voltage",
        "unit": "V",
        "verdict": "missing_physics",
        "summary": "The model lacks static friction.",
        "effects": [
            Effect(
                id="static_friction",
                confidence=0.99,
                parameters={"breakaway_torque": breakaway},
                indistinguishable_from=[["armature_resistance", "torque_constant"]],
                explanation="It sticks harder than it slides.",
            )
        ],
        "parameters": {"spring_preload": preload},
        "changes": [Change(parameter="supply_voltage", time=31.2, before=13.5, after=12.9)],
        "locations": [Location(start=12.1, end=12.6, share=0.08, regime="leaving the closed stop")],
        "regimes": [Regime(variable="angle", range=(0.0, 0.5), unit="rad", share_of_residual=0.74, share_of_time=0.09)],
        "fit": FitQuality(noise_floor=0.004, training=errors, validation=errors, horizons=horizons),
        "candidates": [
            Candidate(id="backlash", validation_rmse=0.06, heldout_rmse=0.06, evidence=12.0, status="rejected")
        ]
        * 20,
        "not_testable": [NotTestable(id="backlash", why="the flanks never part", record="duty below 0")],
        "ruled_out": [
            RuledOut(id="backlash", parameter="gap", below=0.005, unit="rad"),
            RuledOut(id="stop_compliance", parameter="stiffness", above=900.0, unit="N.m/rad"),
        ],
        "remaining": Remaining(share=0.07, looks_like="a slow swing"),
        "excluded": [Excluded(start=30.0, end=32.0, why="messages are missing")],
        "data_quality": DataQuality(
            rate=500.0,
            jitter=0.0,
            gaps=0,
            saturated_share=0.0,
            stops_touched=["closed"],
            excited="angle 0 to 83 degrees",
        ),
        "advice": ["Log the supply voltage."],
    }
    return Diagnosis(**{**fields, **changes})


def result(drawn: int = 5, **changes) -> Result:
    """A result with `drawn` rivals of which the page has the signals, and two recordings."""
    measured = 2.0 + np.sin(TIME)
    signals = {"time": TIME, "measured": measured, "command": 0.1 * np.sin(TIME)}
    signals |= dict.fromkeys(("nominal", "recalibrated", "final"), measured + 0.1)
    said = diagnosis(**changes)
    rivals = [
        Tried(f"rival_{n}", 1, "tied" if n == 0 else "rejected", 0.01, 0.02, 5.0 * n, f"rival-{n}")
        for n in range(drawn)
    ]
    tried = (Tried("static_friction", 1, "chosen", 0.004, 0.0042, 0.0, "final"), *rivals)
    keys = ["nominal", "recalibrated", "final", *(row.key for row in rivals)]
    views = tuple(view(name, keys) for name in said.recordings)
    curves = dict.fromkeys(keys[:3], (TIME[:50], TIME[:50]))
    law = Characteristic(
        "friction", "friction", "velocity [rad/s]", "torque [N.m]", curves, Points(TIME[:9], TIME[:9], 0.1 * TIME[:9])
    )
    model = Model.nominal(read_actuator("pierburg"))
    return Result(said, model, (), signals, Exhibits(views, tried, (law,)))


def view(name: str, keys: list[str]) -> View:
    """A minute at 500 Hz less a gap of two seconds, with errors like noise."""
    random = np.random.default_rng(1)
    there = (TIME < 30.0) | (TIME > 32.0)
    time = TIME[there]
    errors = {key: 0.003 * random.standard_normal(time.size) for key in keys}
    state = np.sin(time)
    return View(
        name, time, 2.0 + state, 0.1 * state, state, np.cos(time), errors, ((30.0, 32.0, "messages are missing"),)
    )


def thinned(found: Result) -> Result:
    """A result whose views have every twentieth sample, for what looks at each of them."""
    signals = ("time", "measured", "command", "angle", "velocity")
    views = tuple(
        replace(
            each,
            **{name: getattr(each, name)[::20] for name in signals},
            errors={key: error[::20] for key, error in each.errors.items()},
        )
        for each in found.exhibits.views
    )
    return replace(found, exhibits=replace(found.exhibits, views=views))


LEFT = ResidualTorque(
    angle=[0.0, 1.0],
    velocity=[-1.0, 1.0],
    torque=[[0.01, 0.02], [0.0, -0.03]],
    shape="up to 0.03 N.m that opens",
    over_time=TorqueOverTime(time=[1.0, 2.0], torque=[0.01, None]),
)
