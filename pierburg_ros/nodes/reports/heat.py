"""What the stall protection says on `/diagnostics`, in the controller and in the plant."""

from __future__ import annotations

from collections.abc import Mapping

from pierburg_ros.nodes.core.protection.winding import Winding
from pierburg_ros.nodes.graph.diagnostics import ERROR, WARN, Diagnostics

TASK = "winding"


class HeatReport:
    """The task of one winding."""

    def __init__(self, diagnostics: Diagnostics, winding: Winding) -> None:
        self._diagnostics = diagnostics
        self._winding = winding
        diagnostics.task(TASK, "within its current", self._values)

    def tell(self) -> None:
        """Say what is in force."""
        rated = self._winding.rated_current
        limited = f"stall: the winding is hot, current limited to {rated:.2g} A"
        self._condition(self._winding.limited, "stall_limited", WARN, limited)
        self._condition(self._winding.off, "stall", ERROR, "stall: the winding is too hot: duty 0 until it has cooled")

    def _condition(self, in_force: bool, name: str, level: bytes, text: str) -> None:
        if in_force:
            self._diagnostics.begin(name, level, text, TASK)
        else:
            self._diagnostics.end(name)

    def _values(self) -> Mapping[str, object]:
        return {"heat": round(self._winding.heat, 3), "rated_current_a": round(self._winding.rated_current, 3)}
