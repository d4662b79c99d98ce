"""Play between the shaft and the magnet of the sensor."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from pierburg_ros.effects.effect import Effect, Parameter, Variant, grid
from pierburg_ros.effects.put_in import Channels, Series
from pierburg_ros.intake.bounds import LARGEST
from pierburg_ros.kernel import kernel


def put_in(channels: Channels, values: Mapping[str, float]) -> Channels:
    """What a magnet shows that the measured samples pull along, with its play centred on the first one.

    Exact for every drive, with a sensor of the angle: the play acts after all that moves, and how it ends depends on
    the turning points alone. Those between two samples are missed; noise and steps of the recording below the play are
    lost in it.
    """
    half = 0.5 * values["width"] * abs(channels.per_radian)
    magnet, shown = channels.measured.values[0], np.array(channels.measured.values)
    for k, shaft in enumerate(channels.measured.values):
        magnet = shown[k] = min(max(magnet, shaft - half), shaft + half)
    return replace(channels, measured=Series(channels.measured.time, shown))


EFFECT = Effect(
    id="sensor_hysteresis",
    stage="sensor",
    sentence="The sensor trails behind the shaft by a fixed angle, on the other side after each reversal.",
    equation="total play width between shaft and magnet, centred at the start",
    source="Visintin, Differential Models of Hysteresis (1994)",
    shows_in="each reversal, independent of speed",
    record="slow reversals at several angles",
    parameters=(
        Parameter(
            "width",
            None,
            "total play",
            "rad",
            0.0,
            LARGEST,
            plausible=(0.00255, 0.0255),
            searched=(0.0, 0.32),
            stride=5.0,
        ),
    ),
    strength=("width",),
    mark="reversals",
    typical={"width": 0.002546479},
    variants=(Variant(("width",), grid(width=(0.0032, 0.0127))),),
    # rad: the magnet, and the shaft when the magnet last followed it
    state=("magnet", "followed"),
    linear=True,
    sensors=("hall_voltage", "position"),
    play="width",
    put_in=put_in,
)


@kernel
def dragged(p, magnet, angle):
    """Angle of the magnet [rad] after the shaft has gone monotonically to `angle` [rad]."""
    half = 0.5 * p.width
    return min(max(magnet, angle - half), angle + half)
