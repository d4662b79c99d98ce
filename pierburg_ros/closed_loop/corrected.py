"""A controller for one plant, as a diagnosis has corrected its model: the task of tuning, and what a loop promises."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from pierburg_ros.closed_loop.designs import DESIGNS, SCHEDULE
from pierburg_ros.closed_loop.goal import QUANTITIES, Goal
from pierburg_ros.closed_loop.judgement import Judgement
from pierburg_ros.closed_loop.load import load
from pierburg_ros.closed_loop.plants import HOT, NOMINAL, variations
from pierburg_ros.closed_loop.predictor import dead_time, lag, predictor
from pierburg_ros.closed_loop.tune import RATE, Task
from pierburg_ros.control import Settings
from pierburg_ros.errors import InputError
from pierburg_ros.plant import Model

PIFLC = DESIGNS["PIFLC"]
NO_PREDICTOR = {"predictor_delay": 0.0, "predictor_lag": 0.0}


def task_for(model: Model, goal: Goal, predict: bool | None = None, schedule: bool | None = None) -> Task:
    """The task of tuning the PIFLC for `model`, as it is and with its winding hot.

    Sensor and stops are those of the model. `predict` puts the predictor over its delay and lag; None: where it has
    one. With `schedule` the search also finds which share of the duty that carries the load follows the setpoint;
    None: where there is nothing to predict.
    InputError where the model cannot be controlled by a duty from a Hall voltage.
    """
    refuse_uncontrolled(model)
    late = dead_time(model) + lag(model) > 0.0
    predict = late if predict is None else predict
    schedule = not late if schedule is None else schedule
    known = calibration(model) | (predictor(model, RATE) if predict else NO_PREDICTOR)
    known |= load(model) if schedule else {"load_share": 0.0}
    design = replace(PIFLC, tuned=PIFLC.tuned | (SCHEDULE if schedule else {}), fixed=known)
    return Task(design, goal, variations(model), (NOMINAL, HOT))


def refuse_uncontrolled(model: Model) -> None:
    """Raise InputError where the controller cannot be tuned for an actuator."""
    actuator = model.actuator
    if actuator.drive != "voltage" or actuator.quantity != "hall_voltage" or "spring_stiffness" not in model.values:
        raise InputError(
            f"Actuator {actuator.name} is driven by a {actuator.input} and measures {actuator.quantity}; the controller"
            " is tuned for a duty, a Hall voltage and a spring. Choose such an actuator."
        )


def calibration(model: Model) -> dict[str, float]:
    """The settings that say where the stops are and what the sensor shows there."""
    return {
        "angle_closed": model.actuator.lower_stop,
        "angle_open": model.actuator.upper_stop,
        "hall_voltage_closed": model.values["hall_voltage_closed"],
        "hall_voltage_open": model.values["hall_voltage_open"],
    }


def start(task: Task, in_use: Settings) -> Settings:
    """The settings in use with what is known of the plant: tuning gives nothing that is worse."""
    return in_use.with_values(task.design.fixed)


def starts(task: Task, in_use: Settings) -> list[Settings]:
    """Where tuning begins: `start`, and where there is a schedule also with half and all of the load scheduled."""
    first = start(task, in_use)
    shares = (0.5, 1.0) if "load_share" in task.design.tuned else ()
    return [first, *(first.with_values({"load_share": share}) for share in shares)]


@dataclass(frozen=True)
class Promise:
    """What a loop does at its worst step: medians over the seeds of the noise."""

    settling: float  # [s]
    overshoot: float  # share of the step [1]
    steady_state_error: float  # [rad]
    hunting: float  # peak to peak at standstill [rad]


def promises(judgement: Judgement) -> Mapping[str, Promise]:
    """What a judged controller promises on each plant."""
    return {
        plant: Promise(*(float(judgement.median(plant, name).max()) for name in QUANTITIES))
        for plant in judgement.plants
    }
