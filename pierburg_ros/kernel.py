"""The one place that compiles: `kernel` makes a function run without the interpreter."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ParamSpec, TypeVar

import numba

from pierburg_ros.kernel_cache import KernelCache

Arguments = ParamSpec("Arguments")
Result = TypeVar("Result")


def kernel(function: Callable[Arguments, Result]) -> Callable[Arguments, Result]:
    """Compile `function` when it is first called: cached on disk, releasing the interpreter lock.

    Numba infers the types of each call; a kernel's docstring says what its arguments are, with units. Declaring a
    kernel touches no file and none of Numba's own settings.
    """
    compiled: Any = numba.njit(nogil=True, error_model="numpy")(function)
    compiled._cache = KernelCache(function)  # what cache=True does with a cache in a folder of Numba's choice
    declared: Callable[Arguments, Result] = compiled
    return declared
