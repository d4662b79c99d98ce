"""URDF: two links and their joint, driven by a torque. The form of urdf/valve.urdf, without its looks."""

from __future__ import annotations

import math

from pierburg_ros.export.contents import Contents
from pierburg_ros.export.motor import braking, motor_constant, no_load_speed, stall_torque
from pierburg_ros.export.remarks import remarks
from pierburg_ros.export.shaft import shaft
from pierburg_ros.export.xml import Element, child, document, numbers


def urdf(contents: Contents) -> str:
    """The model as URDF."""
    actuator = contents.model.actuator
    root = Element("robot", {"name": actuator.name})
    child(root, "link", name="housing")
    moving = shaft(contents)
    inertial = child(child(root, "link", name="shaft"), "inertial")
    child(inertial, "origin", xyz=numbers(0, 0, -moving.lever))
    child(inertial, "mass", value=moving.mass)
    own = moving.inertia
    child(inertial, "inertia", ixx=own, ixy=0.0, ixz=0.0, iyy=own, iyz=0.0, izz=own)
    stopped = math.isfinite(actuator.lower_stop) and math.isfinite(actuator.upper_stop)
    joint = child(root, "joint", name=f"{actuator.name}_joint", type="revolute" if stopped else "continuous")
    child(joint, "parent", link="housing")
    child(joint, "child", link="shaft")
    child(joint, "axis", xyz=moving.axis)
    limit = child(joint, "limit", effort=stall_torque(contents), velocity=no_load_speed(contents))
    if stopped:
        limit.attrib.update(lower=numbers(actuator.lower_stop), upper=numbers(actuator.upper_stop))
    damping = braking(contents) + contents.quantity("viscous_damping")
    child(joint, "dynamics", damping=damping, friction=contents.base("coulomb_friction"))
    return document(root, remarks(contents, torque_driven(contents)))


def torque_driven(contents: Contents) -> tuple[str, ...]:
    """How a joint that knows torques alone stands for motor and gear."""
    per_volt = motor_constant(contents) / contents.base("armature_resistance")
    return (
        "Motor and gear are held by what they amount to at the shaft: the effort limit is the stall torque, the",
        "velocity limit the no-load speed, and the damping has the back-EMF in it.",
        f"Command the effort {per_volt:.6g} N.m/V x duty x supply voltage, here {stall_torque(contents):.6g} x duty.",
        "The mass is a guess; the inertia about the other axes too.",
    )
