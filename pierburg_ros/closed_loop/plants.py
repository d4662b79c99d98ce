"""The plants a controller is tuned and judged on: as built, hot, and with each effect of the catalogue."""

from __future__ import annotations

from pierburg_ros.actuators import read_actuator
from pierburg_ros.plant import Model

NOMINAL = "nominal"
HOT = "resistance x 1.42"
STICKY = "static friction x 1.4"

# Strengths are guesses within the ranges that the effects declare as plausible, towards the lower end: an
# actuator still in service. Faults of the sensor stay below the 0.3 degree asked for at standstill, since a
# controller that has nothing but this sensor cannot correct them.
CHANGES: dict[str, dict[str, float]] = {
    NOMINAL: {},
    "resistance x 1.17": {"armature_resistance": 4.139 * 1.17},  # the paper's Fig. 10
    HOT: {"armature_resistance": 4.139 * 1.42},  # the paper's Fig. 11
    STICKY: {"static_friction.breakaway_torque": 1.4 * 0.2007, "static_friction.stribeck_velocity": 0.1},
    "viscous friction": {"viscous_friction.coefficient": 0.03},
    "presliding": {"presliding.stiffness": 40.0, "presliding.damping": 0.03},
    "load-dependent friction": {"load_dependent_friction.coefficient": 0.1},
    "direction-dependent friction": {
        "direction_dependent_friction.viscous_difference": 0.03,
        "direction_dependent_friction.coulomb_difference": 0.03,
    },
    "position-dependent friction": {
        "position_dependent_friction.amplitude": 0.06,
        "position_dependent_friction.center": 0.8,
        "position_dependent_friction.width": 0.15,
    },
    "backlash": {"backlash.gap": 0.015, "backlash.motor_friction_share": 0.2},
    "gear compliance": {"gear_compliance.stiffness": 30.0, "gear_compliance.damping": 0.01},
    "cogging": {
        "cogging_torque.amplitude": 0.03,
        "cogging_torque.periods_per_motor_revolution": 6.0,
    },
    "nonlinear spring": {"nonlinear_spring.cubic_stiffness": 0.05},
    "stop compliance": {"stop_compliance.stiffness": 30.0, "stop_compliance.damping": 0.01},
    "external load": {
        "external_load.torque": 0.05,
        "external_load.amplitude": 0.03,
        "external_load.frequency": 2.0,
        "external_load.end": 1e9,
    },
    "winding heat": {
        "thermal_resistance.thermal_resistance": 20.0,
        "thermal_resistance.heat_capacity": 1.0,
    },
    "supply sag": {"supply_sag.source_resistance": 0.5},
    "PWM dead band": {"pwm_deadband.width": 0.02},
    "armature inductance": {"armature_inductance.inductance": 0.001},
    "input delay": {"input_delay.delay": 0.002},
    "sensor lag": {"sensor_lag.time_constant": 0.002},
    "sensor nonlinearity": {"sensor_nonlinearity.amplitude": 0.0015, "sensor_nonlinearity.half_waves": 1.0},
    "sensor hysteresis": {"sensor_hysteresis.width": 0.004},
    "sensor quantization": {"sensor_quantization.step": 0.005},
}


def plant_set() -> dict[str, Model]:
    """Every plant of the set by name."""
    nominal = Model.nominal(read_actuator("pierburg"))
    return {name: nominal.with_values(changes) for name, changes in CHANGES.items()}
