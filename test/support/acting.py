"""Each effect at a strength that shows, by dotted name: for tests that run over the whole catalogue."""

ACTING = {
    "input_delay": {"delay": 0.008},
    "pwm_deadband": {"width": 0.02},
    "supply_sag": {"source_resistance": 0.5},
    "thermal_resistance": {"thermal_resistance": 20.0, "heat_capacity": 1.0},
    "armature_inductance": {"inductance": 0.002},
    "backlash": {"gap": 0.02, "motor_friction_share": 0.5},
    "gear_compliance": {"stiffness": 20.0, "damping": 0.01},
    "cogging_torque": {"amplitude": 0.03, "periods_per_motor_revolution": 6.0, "phase": 0.4},
    "nonlinear_spring": {"cubic_stiffness": 0.05, "knee_stiffness": 0.1, "knee_angle": 0.5},
    "external_load": {"torque": 0.05, "amplitude": 0.03, "frequency": 2.0, "phase": 0.3, "start": 1.0, "end": 3.0},
    "stop_compliance": {"stiffness": 30.0, "damping": 0.01},
    "viscous_friction": {"coefficient": 0.03},
    "drag": {"quadratic": 0.01, "cubic": 0.002},
    "static_friction": {"breakaway_torque": 0.27, "stribeck_velocity": 0.1},
    "load_dependent_friction": {"coefficient": 0.1},
    "direction_dependent_friction": {"viscous_difference": 0.03, "coulomb_difference": 0.03},
    "position_dependent_friction": {"amplitude": 0.05, "center": 0.7, "width": 0.2},
    "presliding": {"stiffness": 40.0, "damping": 0.03},
    "sensor_hysteresis": {"width": 0.01},
    "sensor_lag": {"time_constant": 0.01},
    "sensor_nonlinearity": {"amplitude": 0.02, "half_waves": 1.0},
    "sensor_quantization": {"step": 0.02},
}


def acting(effect: str) -> dict[str, float]:
    """The values of one effect by dotted name."""
    return {f"{effect}.{name}": value for name, value in ACTING[effect].items()}
