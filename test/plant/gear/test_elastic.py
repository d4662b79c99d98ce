"""The shaft behind elastic teeth against quadrature."""

import numpy as np
import pytest
from scipy.integrate import quad

from pierburg_ros.plant.gear import elastic


@pytest.mark.parametrize("reach", [-2.0, 0.0, 0.01, 0.0299, 0.0301, 0.5, 5.0, 200.0])
def test_what_comes_up_with_the_square_of_time(reach):
    exact = quad(lambda t: np.exp(-reach * (1.0 - t)) * t * t, 0.0, 1.0, points=[0.9], epsabs=1e-13)[0]
    assert elastic.grown(reach, np.expm1(-reach)) == pytest.approx(exact, rel=1e-6)
