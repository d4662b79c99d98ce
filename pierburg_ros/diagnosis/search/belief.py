"""How probable a quantity is beside a remainder, from what it accounts for and from what could take its place.

The likelihood alone says too much: a remainder is not the random process that it is modelled as, and an effect that is
not there may gain thousands. So the probability comes from trials with a known answer (`proof/`), by logistic
regression. `benchmarks/belief.py` makes it again from other trials.
"""

from __future__ import annotations

from scipy.special import expit

PROBABLE = 0.5
"""Least probability at which a quantity is reported. Derived: a wrong name counts as much as a missed one."""
EFFECT = (-4.8, 4.2, 3.1, 2.7)
"""Log odds of an effect: a constant, and the coefficients of the three shares in `of_effect`. Measured: logistic
regression over n = 68 effects, 36 of them right, in 64 trials (seed 901: an effect beside a remainder, a remainder
alone, physics outside the catalogue). With each trial left out of its own regression 85 % are on the right side of 0.5;
without `apart` it is 77 %."""
DRIFT = (-3.8, 1.7, 3.6)
"""Log odds of a drift: a constant, and the coefficients of the two shares in `of_drift`. Measured: logistic regression
over n = 113 drifts, 46 of them right, in trials of the same run."""


def of_effect(carried: float, explains: float, apart: float = 1.0) -> float:
    """Probability, 0 to 1, that an effect is there; without a replacement (`apart` 1) the largest that it can be.

    It has `carried` such a share of the evidence, and `explains` such a share of its own signal and the remainder
    together. The best replacement falls short of it by the share `apart` of its gain.
    """
    constant, carrying, explaining, alone = EFFECT
    return float(expit(constant + carrying * carried + explaining * explains + alone * apart))


def of_drift(carried: float, explains: float) -> float:
    """Probability, 0 to 1, that a parameter has drifted, as for an effect.

    Another drift can often replace it. The report says so, and it counts as no evidence against it.
    """
    constant, carrying, explaining = DRIFT
    return float(expit(constant + carrying * carried + explaining * explains))
