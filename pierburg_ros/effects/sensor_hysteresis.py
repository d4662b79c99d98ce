"""Play between the shaft and the magnet of the sensor."""

from pierburg_ros.effects.effect import CONTRACT, Effect, Parameter
from pierburg_ros.kernel import kernel

EFFECT = Effect(
    id="sensor_hysteresis",
    stage="sensor",
    sentence="The sensor trails behind the shaft by a fixed angle, on the other side after each reversal.",
    equation="total play width between shaft and magnet, centred at the start",
    origin=CONTRACT,
    shows_in="each reversal, independent of speed",
    record="slow reversals at several angles",
    parameters=(Parameter("width", "rad", 0.0, 0.5, (0.004, 0.04), "total play"),),
    strength=("width",),
)


@kernel
def dragged(p, magnet, angle):
    """Angle of the magnet [rad] after the shaft has gone monotonically to `angle` [rad]."""
    half = 0.5 * p.width
    return min(max(magnet, angle - half), angle + half)
