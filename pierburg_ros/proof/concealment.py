"""What each trial draws and how it conceals it, from nothing but the run's seed and the trial's number."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from pierburg_ros.proof.dirt.kinds import DIRT
from pierburg_ros.proof.formulation.values import CATALOGUE, NOMINAL, OUTSIDE
from pierburg_ros.proof.strengths import drift, guesses, remainder, strength
from pierburg_ros.proof.trial import Change, Trial

Random = np.random.Generator
WITHOUT_EFFECT = ("consistent", "drift", "change", "guesses")
WITH_REMAINDER = ("beside", "remainder")
"""One effect beside physics outside the catalogue that leaves ten times the noise, and that physics alone."""
WITH_GUESSES = ("guesses", "beside_guesses")
"""A description of which four numbers are off, and one effect beside such a one."""
LATER = ("drag",)
"""Effects that joined the catalogue after the first trials were drawn."""
FIRST = tuple(effect for effect in CATALOGUE if effect not in LATER)
KINDS = (*FIRST, "consistent", "drift", "change", "two", "outside", *WITH_REMAINDER, *WITH_GUESSES, *LATER)
"""Trials are drawn by the place of their kind: a new one comes last."""
BESIDE = tuple(effect for effect in CATALOGUE if effect != "sensor_quantization")
"""Effects that stand beside a remainder or guesses, in turn; steps of the converter are read from the samples."""
OVER_GRAPH = {**dict.fromkeys(CATALOGUE, 1), "consistent": 3, "drift": 3}
"""Trials of each kind in the smaller run over the ROS graph."""
DIRTY = dict.fromkeys(DIRT, 8)
"""Trials of each kind of dirt: in half of them nothing is hidden, in the others a plain effect."""
PLAIN = ("static_friction", "load_dependent_friction", "sensor_lag", "nonlinear_spring")
"""Effects that are hidden in dirty recordings, in turn."""
SENSOR_NOISES = (0.001, 0.002, 0.002, 0.004, 0.004)  # V
PUBLISHED = {
    **dict.fromkeys(CATALOGUE, 20),
    "consistent": 40,
    "drift": 50,
    "change": 10,
    "two": 12,
    "outside": 12,
    "beside": 80,
    "remainder": 20,
    "guesses": 20,
    "beside_guesses": 40,
}
"""Trials of each kind in the published run: 20 a catalogue effect, 120 without any."""


def draw(kind: str, number: int, seed: int) -> Trial:
    """Trial `number` of a kind; odd ones run in closed loop, most of those with a drifted parameter too."""
    drawn_from = np.random.SeedSequence([seed, KINDS.index(kind), number])
    random = np.random.default_rng(drawn_from)
    closed_loop = number % 2 == 1
    trial = Trial(
        name=f"{kind}-{number:03d}",
        kind=kind,
        seed=int(drawn_from.generate_state(1)[0]),
        effects=_effects(kind, number, random),
        drifted=_drifted(kind, closed_loop, random),
        change=_change(random) if kind == "change" else None,
        remainder=remainder(random) if kind in WITH_REMAINDER else {},
        closed_loop=closed_loop,
        controller=_controller(random) if closed_loop else {},
        noise=float(random.choice(SENSOR_NOISES)),
    )
    return _recorded(trial, random)


def draw_over_graph(kind: str, number: int, seed: int) -> Trial:
    """Closed-loop trial `number` of a kind that the nodes record: at 500 Hz, without a logger's converter."""
    drawn = draw(kind, 2 * number + 1, seed)
    name = f"graph-{kind}-{number:03d}"
    return replace(drawn, name=name, over_graph=True, converter_step=0.0, rate=500.0, duration=60.0)


def draw_dirty(kind: str, number: int, seed: int) -> Trial:
    """Open-loop trial `number` of a kind of dirt; odd ones hide a plain effect.

    What is hidden, and the duty, are the same for all kinds of dirt.
    """
    hidden = PLAIN[number // 2 % len(PLAIN)] if number % 2 else "consistent"
    drawn = draw(hidden, 2 * (number // 2), seed)
    return replace(drawn, name=f"{kind}-{number:03d}", kind=kind, dirt=kind, rate=500.0, duration=60.0)


def _effects(kind: str, number: int, random: Random) -> dict[str, float]:
    if kind in CATALOGUE:
        return strength(kind, random)
    if kind == "outside":
        return strength(list(OUTSIDE)[number // 2 % len(OUTSIDE)], random)
    if kind in ("beside", "beside_guesses"):
        return strength(BESIDE[number // 2 % len(BESIDE)], random)
    if kind == "two":
        first, second = random.choice(list(CATALOGUE), 2, replace=False)
        return {**strength(str(first), random), **strength(str(second), random)}
    return {}


def _drifted(kind: str, closed_loop: bool, random: Random) -> dict[str, float]:
    if kind in WITH_GUESSES:
        return {name: NOMINAL[name] * factor for name, factor in guesses(random).items()}
    concealing = closed_loop and kind not in WITHOUT_EFFECT and random.random() < 0.8
    if not (kind == "drift" or concealing):
        return {}
    name, factor = drift(random, kind)
    return {name: NOMINAL[name] * factor}


def _change(random: Random) -> Change:
    name, factor = drift(random)
    return Change(name, float(random.uniform(15.0, 45.0)), NOMINAL[name], NOMINAL[name] * factor)


def _controller(random: Random) -> dict[str, float]:
    """PIFLC settings: the package's own, or slower ones with less duty, as on the practice bench."""
    if random.random() < 0.4:
        return {}
    return {
        "pi_output_support": float(random.uniform(0.6, 2.5)),
        "integral_gain": float(random.uniform(0.2, 2.0)),
        "positive": 0.5,
        "negative": -0.5,
        "duty_minimum": -0.35,
        "duty_maximum": 0.65,
    }


def _recorded(trial: Trial, random: Random) -> Trial:
    """Most recordings as on the practice bench: 60 s at 500 Hz; some shorter, longer, slower or faster."""
    if trial.kind == "sensor_quantization":
        trial = replace(trial, converter_step=0.0)
    if random.random() < 0.75 or trial.kind == "change":
        return trial
    return replace(
        trial,
        duration=float(random.choice([40.0, 60.0, 90.0])),
        rate=float(random.choice([250.0, 500.0, 1000.0])),
    )


def schedule(counts: Mapping[str, int]) -> list[tuple[str, int]]:
    """Kind and number of all trials, round by round, so that a run cut short has some of each kind."""
    rounds = sorted((number / counts[kind], kind, number) for kind in counts for number in range(counts[kind]))
    return [(kind, number) for _, kind, number in rounds]
