"""First-order sliding motion of the valve, written out from Table I without the simulator."""

import numpy as np

# Table I and 13.5 V, written out: k_g k_m, b = (k_g k_m)^2 / R.
CONSTANT = 37.3 * 0.022
TIME_CONSTANT = CONSTANT**2 / 4.139 / 0.1419
GAIN = CONSTANT * 13.5 / (4.139 * 0.1419)
PRELOAD_ANGLE = 0.29 / 0.1419
FRICTION_ANGLE = 0.2007 / 0.1419
NOISE = 0.003


def sliding(levels, hold, rate):
    """Angle [rad] from rest at 0 under each duty of `levels` for `hold` [s], sampled at `rate` [Hz].

    time_constant w = gain duty - angle - preload_angle - friction_angle sign(w), held wherever it would turn.
    """
    since = np.arange(1, round(hold * rate) + 1) / rate
    parts = [np.zeros(1)]
    for duty in levels:
        angle, centre = parts[-1][-1], GAIN * duty - PRELOAD_ANGLE
        end = np.clip(angle, centre - FRICTION_ANGLE, centre + FRICTION_ANGLE)
        parts.append(np.clip(end + (angle - end) * np.exp(-since / TIME_CONSTANT), 0.0, np.pi / 2))
    return np.concatenate(parts)
