"""URDF: two links and their joint, driven by a torque. The form of urdf/valve.urdf, without its looks."""

from __future__ import annotations

from pierburg_ros.export.contents import Contents
from pierburg_ros.export.motor import INPUTS, NO_LIMIT, braking, largest_speed, largest_torque, torque_per_input
from pierburg_ros.export.remarks import remarks
from pierburg_ros.export.shaft import shaft
from pierburg_ros.export.xml import Element, child, document, numbers

KINDS = {"rotary": "revolute", "linear": "prismatic"}
"""Joints that turn and that slide, in URDF and in SDF."""
GUESS = "Mass and the inertia about the other axes are guesses, but for a pendulum's mass and for what slides."


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
    joint = child(root, "joint", name=actuator.joint or f"{actuator.name}_joint", type=KINDS[actuator.motion])
    if not actuator.has_stops and actuator.motion == "rotary":
        joint.set("type", "continuous")
    child(joint, "parent", link="housing")
    child(joint, "child", link="shaft")
    child(joint, "axis", xyz=moving.axis)
    limit = child(joint, "limit", effort=largest_torque(contents), velocity=largest_speed(contents))
    if joint.get("type") != "continuous":
        lower, upper = max(actuator.lower_stop, -NO_LIMIT), min(actuator.upper_stop, NO_LIMIT)
        limit.attrib.update(lower=numbers(lower), upper=numbers(upper))
    damping = braking(contents) + contents.quantity("viscous_damping")
    child(joint, "dynamics", damping=damping, friction=contents.base("coulomb_friction"))
    return document(root, remarks(contents, torque_driven(contents)))


def torque_driven(contents: Contents) -> tuple[str, ...]:
    """How a joint that knows torques alone stands for motor and gear."""
    drive = contents.model.actuator.drive
    command = f"Command as effort {torque_per_input(contents):.6g} x {INPUTS[drive]}, in N.m (N where it slides)."
    if drive != "voltage":
        return (command, "The description knows no largest effort or velocity.", GUESS)
    return (
        "Motor and gear are held by what they amount to at the shaft: the effort limit is the stall torque, the",
        "velocity limit the no-load speed, and the damping has the back-EMF in it.",
        command,
        GUESS,
    )
