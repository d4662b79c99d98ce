"""Simulates, controls and diagnoses the Pierburg mechatronic actuator.

    import pierburg_ros as pr

    recording = pr.read("bench.csv")
    print(pr.compare(recording, pr.Model.nominal("pierburg")).rmse)
    diagnosis = pr.diagnose(recording)
    diagnosis.save("results/diagnosis")

Nothing is loaded, compiled or touched on disk before it is used.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pierburg_ros.errors import InputError
    from pierburg_ros.fleets.fleet import Fleet, fleet
    from pierburg_ros.library.comparing import Comparison, compare
    from pierburg_ros.library.diagnosing import Diagnosis, diagnose
    from pierburg_ros.library.exporting import Export
    from pierburg_ros.library.identifying import Identification, identify
    from pierburg_ros.library.model import Model
    from pierburg_ros.library.reading import read
    from pierburg_ros.library.recording import Recording
    from pierburg_ros.library.simulation import Simulation, simulate

__all__ = [
    "Comparison",
    "Diagnosis",
    "Export",
    "Fleet",
    "Identification",
    "InputError",
    "Model",
    "Recording",
    "Simulation",
    "compare",
    "diagnose",
    "fleet",
    "identify",
    "read",
    "simulate",
]

_HOME = {
    "Comparison": "library.comparing",
    "Diagnosis": "library.diagnosing",
    "Export": "library.exporting",
    "Fleet": "fleets.fleet",
    "Identification": "library.identifying",
    "InputError": "errors",
    "Model": "library.model",
    "Recording": "library.recording",
    "Simulation": "library.simulation",
    "compare": "library.comparing",
    "diagnose": "library.diagnosing",
    "fleet": "fleets.fleet",
    "identify": "library.identifying",
    "read": "library.reading",
    "simulate": "library.simulation",
}


def __getattr__(name: str) -> Any:
    """What is imported on its first use (PEP 562)."""
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
    if not isinstance(value, type):
        from pierburg_ros.errors import naming_arguments

        value = naming_arguments(value)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted([*__all__, *(name for name in globals() if name.startswith("__"))])
