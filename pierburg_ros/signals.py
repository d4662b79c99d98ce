"""Arrays by what they hold."""

import numpy as np
from numpy.typing import NDArray

Signal = NDArray[np.float64]
"""Numbers over samples, or any other array of floats; a docstring gives its shape and unit."""
Flags = NDArray[np.bool_]
"""Yes or no for each sample."""
