"""SDF 1.9 (Gazebo): two links and their joint, driven by a torque, with the spring that SDF knows."""

from __future__ import annotations

from collections.abc import Mapping

from pierburg_ros.export.contents import Contents
from pierburg_ros.export.motor import NO_LIMIT, braking, largest_speed, largest_torque
from pierburg_ros.export.remarks import remarks
from pierburg_ros.export.shaft import shaft
from pierburg_ros.export.urdf import KINDS, torque_driven
from pierburg_ros.export.xml import Element, child, document, numbers


def sdf(contents: Contents) -> str:
    """The model as SDF."""
    actuator = contents.model.actuator
    root = Element("sdf", {"version": "1.9"})
    model = child(root, "model", name=actuator.name)
    fixed = child(model, "joint", name="mount", type="fixed")
    valued(fixed, {"parent": "world", "child": "housing"})
    child(model, "link", name="housing")
    inertial = child(child(model, "link", name="shaft"), "inertial")
    moving = shaft(contents)
    own = moving.inertia
    valued(inertial, {"pose": numbers(0, 0, -moving.lever, 0, 0, 0), "mass": moving.mass})
    tensor = {"ixx": own, "ixy": 0.0, "ixz": 0.0, "iyy": own, "iyz": 0.0, "izz": own}
    valued(child(inertial, "inertia"), tensor)
    joint = child(model, "joint", name=actuator.joint or f"{actuator.name}_joint", type=KINDS[actuator.motion])
    valued(joint, {"parent": "housing", "child": "shaft"})
    axis = child(joint, "axis")
    valued(axis, {"xyz": moving.axis})
    limits(contents, child(axis, "limit"))
    dynamics(contents, child(axis, "dynamics"))
    return document(root, remarks(contents, torque_driven(contents)))


def limits(contents: Contents, limit: Element) -> None:
    """Where the joint ends, how strong and how fast its motor is, and how the stops give."""
    actuator = contents.model.actuator
    lower, upper = max(actuator.lower_stop, -NO_LIMIT), min(actuator.upper_stop, NO_LIMIT)
    motor = {"effort": largest_torque(contents), "velocity": largest_speed(contents)}
    valued(limit, {"lower": lower, "upper": upper, **motor})
    if stiffness := contents.quantity("contact_stiffness"):
        valued(limit, {"stiffness": stiffness, "dissipation": contents.quantity("contact_damping")})


def dynamics(contents: Contents, element: Element) -> None:
    """Damping, dry friction and the spring, whose preload is the angle at which it is at rest."""
    damping = braking(contents) + contents.quantity("viscous_damping")
    valued(element, {"damping": damping, "friction": contents.base("coulomb_friction")})
    stiffness = contents.base("spring_stiffness")
    if stiffness > 0.0:
        rest = -contents.base("spring_preload") / stiffness
        valued(element, {"spring_reference": rest, "spring_stiffness": stiffness})


def valued(parent: Element, values: Mapping[str, str | float]) -> None:
    """Elements under `parent` with a text each."""
    for name, value in values.items():
        child(parent, name).text = value if isinstance(value, str) else numbers(value)
