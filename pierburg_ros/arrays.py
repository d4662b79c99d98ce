"""The arrays that pass between functions; a docstring tells shape and unit."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Signal = NDArray[np.float64]
"""Numbers, mostly one a sample."""
Flags = NDArray[np.bool_]
"""Yes or no, mostly one a sample."""
