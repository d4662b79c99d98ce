"""A linear plant going on as before: most samples of a recording are one more step of the same piece.

What goes on is either a standstill or x'' + damping x' + stiffness x = constant, of which `slide` has left the
responses in the state; the same command, supply and step, and no event, make the next step two lines.
"""

from __future__ import annotations

from pierburg_ros.kernel import kernel

ALIKE = 1e-9
"""Steps whose lengths differ by less than this share count as one; time stamps are not exact multiples."""


@kernel
def goes_on(p, s, command, supply, closed_bridge, duration):
    """Whether the last step could be repeated for `duration` [s]; then it has been."""
    if not s.steady or s.serial != p.serial or command != s.command or supply != s.supply:
        return False
    if closed_bridge != s.closed_bridge or s.waiting > 0:
        return False
    return s.direction == 0.0 or _slides_on(p, s, duration)


@kernel
def _slides_on(p, s, duration):
    piece = s.piece
    if piece.order != 2 or abs(duration - piece.step) > ALIKE * duration:
        return False
    pull = s.constant - piece.stiffness * s.angle
    angle = s.angle + s.velocity * piece.impulse + pull * piece.integral
    velocity = s.velocity * piece.slope + pull * piece.impulse
    if velocity * s.direction <= 0.0 or not p.lower_stop < angle < p.upper_stop:
        return False
    s.angle = s.motor_angle = angle
    s.velocity = s.motor_velocity = velocity
    return True
