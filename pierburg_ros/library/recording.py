"""A recording as the library's users meet it: it can be drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pierburg_ros import recording

if TYPE_CHECKING:
    import plotly.graph_objects as go


class Recording(recording.Recording):
    """Measured samples of the shaft and the signals that acted on it.

    `time` [s] counts from the first measured sample, shape (samples,). `measured` is the `quantity`: Hall voltage [V],
    position [rad] or speed [rad/s], shape (samples,). `command` is the `input`: signed duty [1], current [A] or torque
    [N.m]; it and the other channels (`supply_voltage` [V], `temperature` [degC], `enabled`, `setpoints` [rad]) have a
    `time` and `values` that each hold until the next one. Of a linear actuator all of them are in m and N.
    """

    def plot(self) -> go.Figure:
        """Measured quantity and input over time, as a Plotly figure with the units of a rotary actuator."""
        from pierburg_ros.library.signal_plot import figure

        return figure(self, self.unit, "rotary", self.name)
