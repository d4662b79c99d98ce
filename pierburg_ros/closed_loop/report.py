"""Tuned controllers side by side, as Markdown tables for people."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pierburg_ros.actuators.actuator import UNITS
from pierburg_ros.closed_loop.course import STEPS, WAYS
from pierburg_ros.closed_loop.goal import QUANTITIES, Goal, settling_bounds
from pierburg_ros.closed_loop.judgement import Judgement
from pierburg_ros.closed_loop.plants import NOMINAL
from pierburg_ros.closed_loop.tune import RATE, STATED
from pierburg_ros.effects import DECLARED
from pierburg_ros.plant import Model

DEGREES = 180.0 / math.pi

BEGIN, END = "<!-- comparison: written by pierburg tune --compare -->", "<!-- end of comparison -->"


@dataclass(frozen=True)
class Column:
    """How a metric is shown: title with unit, factor from SI, decimals."""

    title: str
    factor: float
    decimals: int


COLUMNS = {
    "rise": Column("rise [ms]", 1e3, 0),
    "settling": Column("settling [ms]", 1e3, 0),
    "overshoot": Column("overshoot [%]", 100.0, 1),
    "steady_state_error": Column("steady-state error [°]", DEGREES, 2),
    "absolute_error": Column("IAE [°·s]", DEGREES, 2),
    "effort": Column("effort [s]", 1.0, 3),
    "hunting": Column("hunting [°]", DEGREES, 2),
}
GOALS = len(STEPS) * len(QUANTITIES)  # on each plant
SUMMARY = ("overshoot", "steady_state_error", "absolute_error", "hunting")


def report(goal: Goal, judgements: Sequence[Judgement]) -> str:
    """The whole comparison."""
    plants = plants_table(judgements[0].plants)
    tables = [plants, settings_table(judgements), goals_table(goal, judgements), set_table(goal, judgements)]
    return "\n\n".join(tables + [step_table(judgements, plant) for plant in STATED]) + "\n"


def insert(document: str, comparison: str) -> str:
    """`document` with the comparison between its markers, or at its end if it has none."""
    start, found, rest = document.partition(BEGIN)
    _, _, after = rest.partition(END)
    before = start if found or not start else start.rstrip() + "\n\n"
    return f"{before}{BEGIN}\n\n{comparison}\n{END}{after or chr(10)}"


def section(title: str, header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A titled Markdown table, its first two columns to the left and the others to the right."""
    rule = ["---", "---", *["---:"] * (len(header) - 2)]
    return f"### {title}\n\n" + "\n".join(f"| {' | '.join(row)} |" for row in (header, rule, *rows))


def plants_table(plants: Mapping[str, Model]) -> str:
    """What makes each plant: the values in which it differs from the nominal one."""
    nominal = plants[NOMINAL].values

    def differences(model: Model) -> str:
        changed = (name for name, value in model.values.items() if value != nominal[name])
        return ", ".join(stated(name, model.values[name]) for name in changed) or "nothing"

    return section(
        "Plants", ["plant", "what it changes"], ([name, differences(model)] for name, model in plants.items())
    )


def stated(name: str, value: float) -> str:
    """A parameter of a model by its dotted name, with value and unit."""
    unit = UNITS[name][0] if name in UNITS else DECLARED[name].unit
    return f"`{name}` {value:.6g}" + ("" if unit == "1" else f" {unit}")


def settings_table(judgements: Sequence[Judgement]) -> str:
    """What tuning found."""
    names = [
        name for name in vars(judgements[0].settings) if len({getattr(each.settings, name) for each in judgements}) > 1
    ]
    rows = ([each.name, *(f"{getattr(each.settings, name):g}" for name in names)] for each in judgements)
    return section("Settings found (proportional_gain is 1)", ["controller", *names], rows)


def goals_table(goal: Goal, judgements: Sequence[Judgement]) -> str:
    """For the plants with stated goals: the worst step as a share of its limit."""

    def rows() -> Iterator[Sequence[str]]:
        for plant in STATED:
            for each in judgements:
                shares = each.shares(plant, goal).max(axis=0)
                yield [plant, each.name, *(f"{share:.2f}{' (missed)' if share > 1.0 else ''}" for share in shares)]

    header = ["plant", "controller", *(name.replace("_", " ") for name in QUANTITIES)]
    return section("Goals: median of the worst step as a share of its limit", header, rows())


def set_table(goal: Goal, judgements: Sequence[Judgement]) -> str:
    """For every plant: how many goals are met, and the largest median of each quantity over the steps."""

    def rows() -> Iterator[Sequence[str]]:
        for plant in judgements[0].plants:
            for each in judgements:
                met = int(np.sum(each.shares(plant, goal) <= 1.0))
                yield [plant, each.name, f"{met} of {GOALS}", *plain(extremes(each, plant))]
        for each in judgements:
            met = sum(int(np.sum(each.shares(plant, goal) <= 1.0)) for plant in each.plants)
            worst = np.max([extremes(each, plant) for plant in each.plants], axis=0)
            yield ["**all plants, worst**", each.name, f"{met} of {GOALS * len(each.plants)}", *plain(worst)]

    titles = ["settling / bound", *(COLUMNS[name].title for name in SUMMARY)]
    return section(
        "Every plant of the set: largest median over the steps", ["plant", "controller", "goals met", *titles], rows()
    )


def extremes(each: Judgement, plant: str) -> NDArray[np.float64]:
    """Largest medians over the steps: settling over the nominal bound, then SUMMARY."""
    settling = each.median(plant, "settling") / settling_bounds(each.plants[NOMINAL], RATE)
    others = [COLUMNS[name].factor * each.median(plant, name).max() for name in SUMMARY]
    return np.array([settling.max(), *others])


def plain(values: NDArray[np.float64]) -> list[str]:
    """Numbers with two decimals."""
    return [f"{value:.2f}" for value in values]


def step_table(judgements: Sequence[Judgement], plant: str) -> str:
    """Every metric of every step on one plant, as `median (worst)`: see `cells`."""

    def rows() -> Iterator[Sequence[str]]:
        bounds = settling_bounds(judgements[0].plants[plant], RATE)
        for step in range(0, len(STEPS), WAYS):
            for each in judgements:
                yield [
                    STEPS[step].label,
                    each.name,
                    f"{1e3 * bounds[step : step + WAYS].min():.0f}",
                    *cells(each, plant, step),
                ]

    header = ["step", "controller", "bound [ms]", *(column.title for column in COLUMNS.values())]
    return section(f"Steps on the plant: {plant}", header, rows())


def cells(each: Judgement, plant: str, step: int) -> Iterator[str]:
    """Each metric of a step: the median over the seeds for the worst of its ways, and the worst of all runs."""
    every = slice(step, step + WAYS)
    for name, column in COLUMNS.items():
        median = column.factor * each.median(plant, name)[every].max()
        worst = column.factor * each.worst(plant, name)[every].max()
        yield f"{median:.{column.decimals}f} ({worst:.{column.decimals}f})"
