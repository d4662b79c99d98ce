"""The documentation page of the effects, written from their declarations: `python -m pierburg_ros.effects.page`."""

from __future__ import annotations

from collections.abc import Iterator

from pierburg_ros.effects import EFFECTS, Effect, Parameter
from pierburg_ros.intake.bounds import LARGEST

HEAD = """\
# The effects

Written by `python -m pierburg_ros.effects.page > docs/reference/effects.md`; edit the declarations, not this page.

What the simulator can add to the paper's plant and the diagnosis can name, in the order of the signal path. An effect
is absent, bit for bit, while its strength (bold) is 0; a stiffness of 0 is rigid. Any of them may act together. The
model file and the ROS parameters of `plant` (`effect.parameter`) use the same names.

w is the shaft velocity, x = angle / (pi/2), i the current, T_m = k_g k_m i the motor torque at the shaft, T_c the
Coulomb friction. Load torques are positive when they close. *Accepted* excludes what is impossible. *Plausible* is
where a search starts, as a multiple of the actuator's own scale of the unit (`actuators/scales.py`): stall torque and
current, travel, the time of that travel at no-load speed, supply voltage.
"""


def page() -> str:
    """The page, as Markdown."""
    sources = list(dict.fromkeys(effect.source for effect in EFFECTS))
    sections = (line for effect in EFFECTS for line in _section(effect, sources.index(effect.source) + 1))
    listed = (f"{number}. {source}." for number, source in enumerate(sources, 1))
    return "\n".join([HEAD, *_overview(), *sections, "## Sources\n", *listed, ""])


def _overview() -> Iterator[str]:
    yield "| acts on | effect | in one sentence | shows in | to see it, record |"
    yield "|---|---|---|---|---|"
    for effect in EFFECTS:
        link = f"[{effect.id}](#{effect.id})"
        yield f"| {effect.stage} | {link} | {effect.sentence} | {effect.shows_in} | {effect.record} |"
    yield ""


def _section(effect: Effect, source: int) -> Iterator[str]:
    yield f"## {effect.id}\n"
    yield f"    {effect.equation}\n"
    yield "| parameter | unit | accepted | plausible | default | meaning |"
    yield "|---|---|---|---|---|---|"
    for parameter in effect.parameters:
        yield _row(effect, parameter)
    yield f"\n[Source {source}](#sources).\n"


def _row(effect: Effect, parameter: Parameter) -> str:
    low, high = parameter.plausible
    accepted = " or ".join(f"{choice:g}" for choice in parameter.choices)
    accepted = accepted or _between(parameter.minimum, parameter.maximum)
    default = "0, absent" if parameter.name in effect.strength else "must be given"
    if parameter.name not in effect.strength and parameter.default is not None:
        default = f"{parameter.default:g}"
    name = f"**{parameter.name}**" if parameter.name in effect.strength else parameter.name
    return f"| {name} | {parameter.unit} | {accepted} | {low:g} to {high:g} | {default} | {parameter.meaning} |"


def _between(minimum: float, maximum: float) -> str:
    """A range in words."""
    if maximum < LARGEST:
        return f"{minimum:g} to {maximum:g}"
    return "any" if minimum == -LARGEST else f"{minimum:g} or more"


if __name__ == "__main__":
    print(page(), end="")
