"""Inductance of the armature winding."""

from pierburg_ros.effects.effect import Effect, Parameter

EFFECT = Effect(
    id="armature_inductance",
    stage="drive",
    sentence="The motor current follows the voltage a little late.",
    equation="inductance di/dt = u - R i - k_g k_m w",
    origin="equation (5) of the paper",
    shows_in="fractions of a millisecond after each change of duty",
    record="samples at 10 kHz or a current measurement",
    parameters=(Parameter("inductance", "H", 0.0, 0.1, (0.0001, 0.005), "of the winding"),),
    strength=("inductance",),
)
