"""The signal path of the plant, top to bottom: command in, delay, drive, mechanics, heat, sensor."""

from __future__ import annotations

import math

import numpy as np

from pierburg_ros.kernel import kernel
from pierburg_ros.plant.gear import elastic, play, rigid
from pierburg_ros.plant.motion.watch import stood
from pierburg_ros.plant.state import QUEUE
from pierburg_ros.plant.torques import drive, sensor

LONGEST_STRETCH = 0.021
"""Longest stretch over which input in force and resistance stay, and the shaft's velocity for the sensor's lag, as a
share of the actuator's own time; 2 ms for the valve."""
FORGOTTEN = 20.0
"""Time constants of the winding after which its current has forgotten the command before, to rounding."""
SUSTAINED = 1e5
"""Events in the actuator's own time that may go on: an event takes up to a microsecond, so that no run takes much
longer than the motion of the valve itself, which has about 200."""
BURST = 1e6
"""Events beyond those, as at an impact: about a second of computing. More mean that a set cannot be simulated."""


@kernel
def advance(p, s, command, supply_voltage, closed_bridge, duration):
    """Let `command` act for `duration` [s]; `supply_voltage` [V] not a number means the nominal one.

    Changes the state record `s`, and puts the samples that are due in it. A state that is not finite afterwards says
    that the parameters cannot be simulated; validate before.
    """
    supply = p.supply_voltage if math.isnan(supply_voltage) else supply_voltage
    if p.input_delay.delay == 0.0 and s.waiting == 0:
        _act(p, s, command, supply, closed_bridge, duration)
    else:
        _act_late(p, s, command, supply, closed_bridge, duration)


@kernel
def recall(p, s, times, command, supply_voltage, closed_bridge):
    """Let what was commanded before the present time of `s` be under way: `command` since each of `times` [s].

    `supply_voltage` [V] and `closed_bridge` are the present ones. A delayed command goes on arriving, and behind an
    inductance those that have arrived have driven their current, at the motor's present velocity.
    """
    supply = p.supply_voltage if math.isnan(supply_voltage) else supply_voltage
    arrived = np.searchsorted(times, s.time - p.input_delay.delay, side="right") - 1
    remembered = FORGOTTEN * p.armature_inductance.inductance / p.armature_resistance
    first = arrived
    while first > 0 and times[first] + p.input_delay.delay > s.time - remembered:
        first -= 1
    for index in range(max(first, 0), arrived + 1):
        until = times[index + 1] + p.input_delay.delay if index < arrived else s.time
        s.arrived = command[index]
        drive.switch(p, s, command[index], supply, closed_bridge)
        if remembered > 0.0:
            s.current = drive.relaxed_current(p, s, until - times[index] - p.input_delay.delay)
    if remembered > 0.0:
        s.current -= s.braking * s.motor_velocity / (p.gear_ratio * p.torque_constant)
    for sent in range(arrived + 1, times.size):
        _enqueue(s, times[sent] + p.input_delay.delay, command[sent])


@kernel
def _act_late(p, s, command, supply, closed_bridge, duration):
    """Put `command` under way and let those that arrive act, for `duration` [s]."""
    _enqueue(s, s.time + p.input_delay.delay, command)
    end = s.time + duration
    in_force = s.arrived
    while s.time < end:
        while s.waiting > 0 and s.queue_time[s.first] <= s.time:
            in_force = s.queue_command[s.first]
            s.first = (s.first + 1) % QUEUE
            s.waiting -= 1
        until = min(end, s.queue_time[s.first]) if s.waiting > 0 else end
        _act(p, s, in_force, supply, closed_bridge, until - s.time)
        s.time = until


@kernel
def _enqueue(s, time, command):
    """Put a change of command under way; in a full queue the newest is replaced."""
    newest = s.queue_command[(s.first + s.waiting - 1) % QUEUE] if s.waiting > 0 else s.arrived
    if command == newest:
        return
    if s.waiting < QUEUE:
        s.waiting += 1
    last = (s.first + s.waiting - 1) % QUEUE
    s.queue_time[last], s.queue_command[last] = time, command


@kernel
def _act(p, s, command, supply, closed_bridge, duration):
    """One command, arrived at the driver, for `duration` [s]."""
    s.arrived = command
    if math.isnan(s.angle):
        s.time += duration
        return
    stretches, longest = 1, LONGEST_STRETCH * p.own.time
    if p.creeps and duration > longest:
        stretches = max(math.ceil(duration / longest - 1e-6), 1)
    stretch = duration / stretches
    for _ in range(stretches):
        in_force = command
        drive.switch(p, s, in_force, supply, closed_bridge)
        _mechanics(p, s, stretch)


@kernel
def _mechanics(p, s, duration):
    """Move motor and shaft for `duration` [s], event by event."""
    end = s.time + duration
    remaining, often = duration, SUSTAINED / p.own.time
    heats = p.thermal_resistance.thermal_resistance != 0.0
    while s.events < BURST:
        start, amperes = s.motor_angle, s.current
        if p.gear_compliance.stiffness != 0.0:
            used = elastic.move(p, s, remaining)
        elif p.backlash.gap != 0.0:
            used = play.move(p, s, remaining)
        else:
            used = rigid.move(p, s, remaining)
        if p.sensor_moves:
            sensor.follow(p, s, used)
        if heats and used > 0.0:
            drive.warm(p, s, s.motor_angle - start, s.current - amperes, used)
        stood(p, s, s.time)
        s.events = max(s.events + 1.0 - used * often, 0.0)
        remaining -= used
        if not remaining > 0.0:
            s.time = end
            return
    s.angle = s.velocity = math.nan
    s.time = end
