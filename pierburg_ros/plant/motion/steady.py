"""A linear plant going on as before: most samples of a recording are one more step of the same piece.

What goes on is either a standstill or x'' + damping x' + stiffness x = constant, of which `slide` has left the
responses in the state; the same command, supply and step, and no event, make the next step two lines.
"""

from __future__ import annotations

from pierburg_ros.kernel import kernel
from pierburg_ros.plant.torques.sensor import SPEED, shown

ALIKE = 1e-9
"""Steps whose lengths differ by less than this share count as one; time stamps are not exact multiples."""


@kernel
def goes_on(p, s, command, supply, closed_bridge, duration):
    """Whether the last step could be repeated for `duration` [s]; then it has been."""
    if not holds(p, s, command, supply, closed_bridge):
        return False
    if s.direction == 0.0:
        return True
    if not _alike(s.piece, duration):
        return False
    angle, velocity = _moved(_step(s.piece, s.constant), s.angle, s.velocity)
    if not _free(p, s, angle, velocity):
        return False
    s.angle = s.motor_angle = angle
    s.velocity = s.motor_velocity = velocity
    return True


@kernel
def holds(p, s, command, supply, closed_bridge):
    """Whether the motion of the last step goes on under these inputs."""
    if not s.steady or s.serial != p.serial or command != s.command or supply != s.supply:
        return False
    return closed_bridge == s.closed_bridge and s.waiting == 0


@kernel
def sampled_on(p, s, sample_times, first, until, output):
    """Put what the sensor is shown from sample `first` on into `output`, while the motion goes on and before `until`.

    Only where it `holds`, from the sample before. Gives the first of the samples that is still to come.
    """
    if s.direction == 0.0:
        sample = _stood(sample_times, first, until, output, shown(p, s))
    else:
        sample = _slid(p, s, sample_times, first, until, output)
    s.time += sample_times[sample - 1] - sample_times[first - 1]
    return sample


@kernel
def _stood(sample_times, sample, until, output, value):
    while sample < sample_times.size and sample_times[sample] < until:
        output[sample] = value
        sample += 1
    return sample


@kernel
def _slid(p, s, sample_times, sample, until, output):
    angle, velocity, step = s.angle, s.velocity, _step(s.piece, s.constant)
    shows_speed = p.sensor == SPEED
    while sample < sample_times.size and sample_times[sample] < until:
        after = _moved(step, angle, velocity)
        if not _alike(s.piece, sample_times[sample] - sample_times[sample - 1]) or not _free(p, s, after[0], after[1]):
            break
        angle, velocity = after
        output[sample] = velocity if shows_speed else angle
        sample += 1
    s.angle = s.motor_angle = angle
    s.velocity = s.motor_velocity = velocity
    return sample


@kernel
def _alike(piece, duration):
    """Whether a step of `duration` [s] is that of the piece."""
    return piece.order == 2 and abs(duration - piece.step) <= ALIKE * duration


@kernel
def _free(p, s, angle, velocity):
    """Whether the shaft still slides the same way, between its stops."""
    return velocity * s.direction > 0.0 and p.lower_stop < angle < p.upper_stop


@kernel
def _step(piece, constant):
    """One step of a piece as rows of a matrix, for angle and for velocity: by angle, by velocity, and alone."""
    return (
        (1.0 - piece.stiffness * piece.integral, piece.impulse, constant * piece.integral),
        (-piece.stiffness * piece.impulse, piece.slope, constant * piece.impulse),
    )


@kernel
def _moved(step, angle, velocity):
    """Angle [rad] and velocity [rad/s] one step later."""
    return (
        step[0][2] + step[0][1] * velocity + step[0][0] * angle,
        step[1][2] + step[1][0] * angle + step[1][1] * velocity,
    )
