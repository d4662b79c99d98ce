"""MuJoCo (MJCF): a joint with spring, stops and friction, driven by MuJoCo's own `dcmotor` actuator.

Names and units are those of MuJoCo's XML reference, version 4.0.0 (2026); the equations of `dcmotor` those of its note
"MuJoCo DC Motor Model". Its numbers count at the motor: the gear turns torques, stiffnesses and velocities over.
"""

from __future__ import annotations

import math

import numpy as np

from pierburg_ros.effects import COPPER
from pierburg_ros.export.contents import Contents
from pierburg_ros.export.motor import INPUTS, NO_LIMIT, braking, motor_constant, torque_per_input
from pierburg_ros.export.remarks import remarks
from pierburg_ros.export.shaft import STANDARD_GRAVITY, shaft
from pierburg_ros.export.xml import Element, child, document, numbers

TIMESTEP = 1e-4
"""Longest step [s]. Measured: with it the nominal valve differs from ours by 0.03 mrad RMS, at 1 ms by 0.5
(`docs/export.md`)."""
CONTACT_STEPS = 4.0
"""Steps in the shortest time constant of a contact. Derived: MuJoCo integrates bristles explicitly, which is stable
above 1; at 4 the step of 0.1 ms gave 0.15 mrad RMS against our own bristles, at 1.5 no less."""
SOFT_IMPEDANCE = 0.01
"""Impedance of elastic stops. Derived: MuJoCo lets the inertia in contact grow by 1 / (1 - impedance), 1 % here."""
RIGID = "0.9999 0.9999 0.001"
"""Impedance of rigid stops and dry friction: the largest that MuJoCo takes."""


def mujoco(contents: Contents) -> str:
    """The model as MJCF."""
    step = timestep(contents)
    root = Element("mujoco", {"model": contents.model.actuator.name})
    child(root, "compiler", angle="radian", autolimits="true")
    gravity = numbers(0, 0, -STANDARD_GRAVITY) if contents.base("gravity_torque") else "0 0 0"
    child(root, "option", timestep=step, integrator="discrete", gravity=gravity)
    body = child(child(root, "worldbody"), "body", name="shaft")
    joint(contents, body, step)
    moving = shaft(contents)
    place, own = numbers(0, 0, -moving.lever), numbers(moving.inertia, moving.inertia, moving.inertia)
    child(body, "inertial", pos=place, mass=moving.mass, diaginertia=own)
    drive(contents, child(root, "actuator"), step)
    sensors = child(root, "sensor")
    child(sensors, "jointpos", name="angle", joint="shaft")
    child(sensors, "jointvel", name="velocity", joint="shaft")
    characteristic(contents, root)
    return document(root, remarks(contents, driven(contents)))


def driven(contents: Contents) -> tuple[str, ...]:
    """What `ctrl` is, and what the integrator needs."""
    needs = "The integrator `discrete` came with MuJoCo 3.13; before it, take `implicitfast` with a tenth of the step."
    if contents.model.actuator.drive == "voltage":
        supply = contents.base("supply_voltage")
        volts = f"duty x supply voltage, here duty x {supply:g}"
        return (f"ctrl is the armature voltage in V: {volts}; no open bridge.", needs)
    return (f"ctrl is the {INPUTS[contents.model.actuator.drive]}.", needs)


def timestep(contents: Contents) -> float:
    """Step [s] that resolves bristles and winding, at most `TIMESTEP`."""
    steps = [TIMESTEP]
    stiffness, inductance = contents.quantity("bristle_stiffness"), contents.quantity("winding_inductance")
    if stiffness > 0.0:
        steps.append(total_damping(contents) / (CONTACT_STEPS * stiffness))
    if inductance > 0.0:
        steps.append(math.sqrt(inductance * contents.base("total_inertia")) / motor_constant(contents) / CONTACT_STEPS)
    return float(f"{min(steps):.1g}")


def total_damping(contents: Contents) -> float:
    """What damps the sliding shaft [N.m.s/rad]: back-EMF, viscous friction and bristles."""
    viscous = contents.quantity("viscous_damping") + contents.quantity("bristle_damping")
    return braking(contents) + viscous


def joint(contents: Contents, body: Element, step: float) -> None:
    """The hinge: spring, stops, viscous friction, and dry friction that is not LuGre."""
    actuator = contents.model.actuator
    kind = "hinge" if actuator.motion == "rotary" else "slide"
    hinge = child(body, "joint", name="shaft", type=kind, axis=shaft(contents).axis)
    hinge.attrib.update(spring(contents))
    if actuator.has_stops:
        hinge.set("range", numbers(max(actuator.lower_stop, -NO_LIMIT), min(actuator.upper_stop, NO_LIMIT)))
        hinge.attrib.update(stops(contents, step))
    damping = contents.quantity("viscous_damping")
    if damping > 0.0:
        hinge.set("damping", numbers(damping))
    if not has_bristles(contents):
        friction = contents.base("coulomb_friction")
        reference = numbers(2.0 * step, 1.0)
        hinge.attrib.update({"frictionloss": numbers(friction), "solreffriction": reference, "solimpfriction": RIGID})


def spring(contents: Contents) -> dict[str, str]:
    """The spring with its preload, k angle + c angle^3 + preload, about the angle at which MuJoCo's is at rest."""
    linear, cubic = contents.base("spring_stiffness"), contents.quantity("spring_cubic_stiffness")
    if linear == 0.0 and cubic == 0.0:
        return {}
    preload = contents.base("spring_preload")
    roots = np.roots([cubic, 0.0, linear, preload] if cubic else [linear, preload])
    rest = float(roots[np.argmin(np.abs(roots.imag))].real)
    coefficients = (linear + 3.0 * cubic * rest**2, 3.0 * cubic * rest, cubic) if cubic else (linear,)
    return {"stiffness": numbers(*coefficients), "springref": numbers(rest)}


def stops(contents: Contents, step: float) -> dict[str, str]:
    """Stops: rigid within two steps, or with the stiffness and damping of an elastic contact.

    MuJoCo's contact accelerates by -k p - b dp/dt and lets (1 - impedance) of the free acceleration through, so that
    its stiffness against a torque is inertia x k x impedance / (1 - impedance); the integrator `discrete` counts what
    the damping takes up in a step as inertia. Found by comparison: 0.06 mrad RMS so, 5.8 without that inertia.
    """
    stiffness, damping = contents.quantity("contact_stiffness"), contents.quantity("contact_damping")
    if stiffness == 0.0:
        return {"solreflimit": numbers(2.0 * step, 1.0), "solimplimit": RIGID}
    contents.notes.append("The elastic stops hold for this integrator and this step.")
    electric = 0.0 if contents.quantity("winding_inductance") else braking(contents)
    implicit = step * (electric + contents.quantity("viscous_damping"))
    per_torque = (1.0 - SOFT_IMPEDANCE) / (contents.base("total_inertia") + implicit)
    reference = numbers(-stiffness * per_torque, -damping * per_torque)
    return {"solreflimit": reference, "solimplimit": numbers(SOFT_IMPEDANCE, SOFT_IMPEDANCE, 0.001)}


def drive(contents: Contents, actuators: Element, step: float) -> None:
    """The motor behind its gear; where current or torque are driven, a passive one beside it ripples and rubs."""
    gear = contents.base("gear_ratio") if "gear_ratio" in contents.model.actuator.parameters else 1.0
    if contents.model.actuator.drive == "voltage":
        motor = child(actuators, "dcmotor", name="motor", joint="shaft", gear=gear)
        winding(contents, motor)
        passive = motor
    else:
        motor = child(actuators, "motor", name="motor", joint="shaft", gear=torque_per_input(contents))
        passive = Element("dcmotor", name="friction", joint="shaft", gear=numbers(gear), input="none")
        passive.attrib.update(motorconst="0 0", resistance="1")
    if ripple := contents.quantity("ripple_torque"):
        phase = contents.quantity("ripple_phase") + math.pi
        passive.set("cogging", numbers(ripple / gear, contents.quantity("ripple_periods"), phase))
    if has_bristles(contents):
        passive.set("lugre", bristles(contents, gear, step))
    if passive is not motor and ("cogging" in passive.attrib or "lugre" in passive.attrib):
        actuators.append(passive)
    if delay := contents.quantity("command_delay"):
        motor.attrib.update({"delay": numbers(delay), "nsample": str(math.ceil(delay / step - 1e-9))})


def winding(contents: Contents, motor: Element) -> None:
    """Motor constant and winding, with its inductance and its heat."""
    constant, supply = contents.base("torque_constant"), contents.base("supply_voltage")
    motor.set("motorconst", numbers(constant, constant))
    motor.set("resistance", numbers(contents.base("armature_resistance")))
    motor.set("ctrlrange", numbers(-supply, supply))
    if inductance := contents.quantity("winding_inductance"):
        motor.set("inductance", numbers(inductance, 0))
    if heat := contents.quantity("winding_heat_resistance"):
        motor.set("thermal", numbers(heat, contents.quantity("winding_heat_capacity"), 0, COPPER, 20, 20))


def has_bristles(contents: Contents) -> bool:
    """Whether friction needs the LuGre form: it sticks harder than it slides, or gives before it slides."""
    return contents.quantity("breakaway_friction") > 0.0 or contents.quantity("bristle_stiffness") > 0.0


def bristles(contents: Contents, gear: float, step: float) -> str:
    """Friction of LuGre at the motor: stiffness, damping, sliding and breakaway torque, Stribeck velocity."""
    sliding = contents.base("coulomb_friction")
    stiffness, damping = contents.quantity("bristle_stiffness"), contents.quantity("bristle_damping")
    if stiffness == 0.0:
        taken_up = total_damping(contents) + contents.base("total_inertia") / (CONTACT_STEPS * step)
        stiffness = taken_up / (CONTACT_STEPS * step)
        given = sliding / stiffness
        contents.notes.append(f"Friction is rigid in the model, here it gives {given:.2g} rad before it slides.")
    static = max(contents.quantity("breakaway_friction"), sliding)
    fading = max(contents.quantity("stribeck_speed"), 1e-6)
    return numbers(stiffness / gear**2, damping / gear**2, sliding / gear, static / gear, fading * gear)


def characteristic(contents: Contents, root: Element) -> None:
    """What the sensor makes of angle or velocity, as custom numbers: MuJoCo scales no sensor."""
    actuator = contents.model.actuator
    if actuator.quantity == "hall_voltage":
        name, data = "hall_voltage", (contents.base("hall_voltage_closed"), contents.base("hall_voltage_open"))
        span = numbers(actuator.sensor_span)
        note = f"Sensor: the angle. Hall voltage = closed + (open - closed) x angle / {span}; both in `hall_voltage`."
    else:
        name, data = "sensor", (contents.base("sensor_offset"), contents.base("sensor_scale"))
        note = "Sensor: true values. Measured value = offset + scale x true value; both in `sensor`."
    if data != (0.0, 1.0):
        child(child(root, "custom"), "numeric", name=name, data=numbers(*data))
        contents.notes.append(note)
