"""Modelica: the equations as text, without a library. Friction in the LuGre form, stops as stiff contacts.

Contacts that the model has rigid give a little here (`GIVE`), so that the text is a plain system of differential
equations without events that any tool solves with a stiff method.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence

from pierburg_ros.effects import DECLARED, Effect
from pierburg_ros.effects.effect import Place
from pierburg_ros.export.contents import Contents
from pierburg_ros.export.motor import INPUTS, typical_torque
from pierburg_ros.export.remarks import remarks

GIVE = 1e-4
"""Share of the travel by which friction gives before it slides, and a stop under the stall torque. Chosen: a thousandth
would be seen in a sensor of usual noise, and a smaller one makes the equations stiffer; not varied."""
UNSTOPPED = 2.0 * math.pi
"""Travel [rad] of an actuator without stops: a turn."""
RESIDUAL_FRICTION = 1e-9
"""Least friction level [N.m] that the equations divide by."""


def modelica(contents: Contents) -> str:
    """The model as one Modelica class."""
    acting = contents.equations()
    name = re.sub(r"\W", "_", contents.model.actuator.name)
    name = name if name[0].isalpha() else f"m_{name}"
    parameters, body = list(declared(contents, acting)), list(equations(contents, acting))
    variables = list(variables_of(acting))
    about = remarks(contents, (f"The input is the {INPUTS[contents.model.actuator.drive]}.",))
    lines = [f"// {line}" for line in about]
    lines += [f'model {name} "{plain(contents.model.actuator.title)}"']
    lines += [f"  {line};" for line in (*parameters, *VARIABLES, *signals(contents, acting), *variables)]
    lines += ["equation", *(f"  {line};" for line in body), f"end {name};"]
    return "\n".join(lines) + "\n"


VARIABLES = (
    "constant Real pi = 3.141592653589793",
    'Real angle(start = start_angle, fixed = true, unit = "rad")',
    'Real velocity(start = 0, fixed = true, unit = "rad/s")',
    'Real bristle(start = start_bristle, fixed = true, unit = "rad") "deflection of the friction contact"',
    "Real command, motor_torque, friction_level, bristle_rate, friction, load, stop",
)


def declared(contents: Contents, acting: Sequence[tuple[Effect, Mapping[Place, str]]]) -> Iterator[str]:
    """Every parameter with unit and meaning; those of effects as effect_parameter."""
    yield 'parameter Real start_angle = 0 "angle at the start [rad]"'
    actuator = contents.model.actuator
    for name, base in actuator.parameters.items():
        yield f'parameter Real {name} = {contents.base(name)!r} "{plain(base.meaning)} [{actuator.unit_of(name)}]"'
    yield f'parameter Real sensor_span = {actuator.sensor_span!r} "over which the sensor is straight"'
    for effect, _ in acting:
        for parameter in effect.names:
            about = DECLARED[f"{effect.id}.{parameter}"]
            value = contents.model.values[f"{effect.id}.{parameter}"]
            unit = actuator.unit_of(f"{effect.id}.{parameter}")
            yield f'parameter Real {effect.id}_{parameter} = {value!r} "{plain(about.meaning)} [{unit}]"'
    yield from rigid(contents, acting)


def rigid(contents: Contents, acting: Sequence[tuple[Effect, Mapping[Place, str]]]) -> Iterator[str]:
    """Stiffnesses of what the model has rigid, and how the bristles of friction that is not rigid lean at the start."""
    places = {place for _, terms in acting for place in terms}
    actuator = contents.model.actuator
    travel = actuator.upper_stop - actuator.lower_stop
    give = GIVE * (travel if math.isfinite(travel) else UNSTOPPED)
    leaning = 0.0
    if "bristle_stiffness" in places and contents.model.actuator.has_stops:
        leaning = -contents.base("coulomb_friction") / contents.quantity("bristle_stiffness")
    yield f'parameter Real start_bristle = {leaning!r} "as closing onto the stop has left it [rad]"'
    if "bristle_stiffness" not in places:
        stiffness = max(contents.base("coulomb_friction"), GIVE * typical_torque(contents)) / give
        damping = 2.0 * math.sqrt(stiffness * contents.base("total_inertia"))
        yield f'parameter Real bristle_stiffness = {stiffness:.6g} "of friction, rigid in the model [N.m/rad]"'
        yield f'parameter Real bristle_damping = {damping:.6g} "of friction before it slides [N.m.s/rad]"'
        contents.notes.append(f"Friction is rigid in the model; here it gives {give:.2g} rad before it slides.")
    if "stop_stiffness" not in places and contents.model.actuator.has_stops:
        pressed = (typical_torque(contents) + contents.base("spring_preload")) / give
        damping = 2.0 * math.sqrt(pressed * contents.base("total_inertia"))
        yield f'parameter Real stop_stiffness = {pressed:.6g} "of the stops, rigid in the model [N.m/rad]"'
        yield f'parameter Real stop_damping = {damping:.6g} "of the stops [N.m.s/rad]"'
        contents.notes.append(f"Stops are rigid in the model; here they give {give:.2g} rad under the stall torque.")


def signals(contents: Contents, acting: Sequence[tuple[Effect, Mapping[Place, str]]]) -> Iterator[str]:
    """Input, output, and the motor current, which is a state where the winding is inductive."""
    actuator = contents.model.actuator
    yield f'input Real {actuator.input} "{INPUTS[actuator.drive]}"'
    yield f'output Real {actuator.quantity} "as the sensor gives it [{actuator.unit}]"'
    if actuator.drive == "voltage":
        inductive = any("inductance" in terms for _, terms in acting)
        yield "Real voltage, resistance"
        yield f'Real current{"(start = 0, fixed = true)" if inductive else ""} "of the motor [A]"'


def variables_of(acting: Sequence[tuple[Effect, Mapping[Place, str]]]) -> Iterator[str]:
    """What effects remember."""
    for _, terms in acting:
        if "variable" in terms:
            yield f"Real {terms['variable']}"


def equations(contents: Contents, acting: Sequence[tuple[Effect, Mapping[Place, str]]]) -> Iterator[str]:
    """The equations in the order of the signal path: (1) to (8) of the paper and what effects change."""

    def added(place: Place) -> str:
        return "".join(f" + {filled(effect, terms[place])}" for effect, terms in acting if place in terms)

    further: list[str] = []
    yield f"command = {changed(acting, 'command', contents.model.actuator.input, further)}"
    yield from drive(contents, added)
    yield f"friction_level = max(coulomb_friction{added('friction_level')}, {RESIDUAL_FRICTION:g})"
    stiffness = added("bristle_stiffness").removeprefix(" + ") or "bristle_stiffness"
    yield f"bristle_rate = velocity - abs(velocity)*bristle*{stiffness}/friction_level"
    yield "der(bristle) = bristle_rate"
    bristles = added("bristle_damping").removeprefix(" + ") or "bristle_damping"
    viscous = added("damping").removeprefix(" + ")
    sliding = f" + ({viscous})*velocity" if viscous else ""
    yield f"friction = {stiffness}*bristle + {bristles}*bristle_rate{sliding}"
    yield f"load = {at_rest(contents)}{added('load')}"
    yield f"stop = {stop(contents, added)}"
    yield "der(angle) = velocity"
    yield "der(velocity) = (motor_torque - load - friction - stop)/total_inertia"
    speed = contents.model.actuator.quantity == "speed"
    sensed = changed(acting, "sensed", "velocity" if speed else "angle", further)
    yield f"{contents.model.actuator.quantity} = {changed(acting, 'measured', sensor(contents, sensed), further)}"
    yield from further
    yield from (filled(e, t["equation"]) for e, t in acting if "equation" in t and "{input}" not in t["equation"])


def drive(contents: Contents, added: Callable[[Place], str]) -> Iterator[str]:
    """From the command to the torque of the motor."""
    kind = contents.model.actuator.drive
    if kind != "voltage":
        scale = "torque_scale*" if "torque_scale" in contents.model.actuator.parameters else ""
        yield f"motor_torque = {scale if kind == 'torque' else 'gear_ratio*torque_constant*'}command"
        return
    inductance = added("inductance").removeprefix(" + ")
    driving = "voltage - gear_ratio*torque_constant*velocity"
    yield "voltage = command*supply_voltage"
    yield f"resistance = armature_resistance{added('resistance')}"
    lagging = f"der(current) = ({driving} - resistance*current)/{inductance}"
    yield lagging if inductance else f"current = ({driving})/resistance"
    yield "motor_torque = gear_ratio*torque_constant*current"


def changed(acting: Sequence[tuple[Effect, Mapping[Place, str]]], place: Place, signal: str, further: list[str]) -> str:
    """`signal` after all effects that change it at a place; equations that they bring go to `further`."""
    for effect, terms in acting:
        if place in terms:
            if "{input}" in terms.get("equation", ""):
                further.append(filled(effect, terms["equation"], signal))
            signal = filled(effect, terms[place], signal)
    return signal


def filled(effect: Effect, term: str, signal: str = "") -> str:
    """A term with the names of the effect's parameters as they are declared, and the signal that it changes."""
    return term.format(input=signal, **{name: f"{effect.id}_{name}" for name in effect.names})


def at_rest(contents: Contents) -> str:
    """The load of the actuator itself."""
    names = contents.model.actuator.parameters
    terms = {
        "spring_preload": "spring_preload",
        "spring_stiffness": "spring_stiffness*angle",
        "gravity_torque": "gravity_torque*sin(angle)",
    }
    return " + ".join(term for name, term in terms.items() if name in names) or "0"


def stop(contents: Contents, added: Callable[[Place], str]) -> str:
    """Torque of the stops, positive closes: one-sided springs with dampers."""
    if not contents.model.actuator.has_stops:
        return "0"
    stiffness = added("stop_stiffness").removeprefix(" + ") or "stop_stiffness"
    damping = added("stop_damping").removeprefix(" + ") or "stop_damping"
    lower, upper = contents.model.actuator.lower_stop, contents.model.actuator.upper_stop
    parts = []
    if math.isfinite(upper):
        beyond = f"(angle - {upper!r})"
        parts.append(f"(if angle > {upper!r} then max({stiffness}*{beyond} + {damping}*velocity, 0) else 0)")
    if math.isfinite(lower):
        beyond = f"({lower!r} - angle)"
        parts.append(f"(if angle < {lower!r} then max({stiffness}*{beyond} - {damping}*velocity, 0) else 0)")
    return " - ".join(parts if math.isfinite(upper) else ["0", *parts])


def sensor(contents: Contents, sensed: str) -> str:
    """What the sensor gives of the angle it senses."""
    if contents.model.actuator.quantity == "hall_voltage":
        return f"hall_voltage_closed + (hall_voltage_open - hall_voltage_closed)*({sensed})/sensor_span"
    parameters = contents.model.actuator.parameters
    scaled = f"sensor_scale*({sensed})" if "sensor_scale" in parameters else sensed
    return f"{scaled} + sensor_offset" if "sensor_offset" in parameters else scaled


def plain(text: str) -> str:
    """A text without what would end a Modelica string."""
    return text.replace("\\", "/").replace('"', "'")
