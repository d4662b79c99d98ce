"""The torque that repeats with every turn of a shaft: a map over one turn."""

from __future__ import annotations

import numpy as np

from pierburg_ros.arrays import Signal
from pierburg_ros.estimation.data import Data
from pierburg_ros.estimation.run import Run
from pierburg_ros.estimation.torque_balance import TURN, Balance, Part, goes_round, left_unseen, over_a_turn
from pierburg_ros.plant import Model
from pierburg_ros.plant.parameters import RESIDUAL_ANGLES

MENTIONED = 4
"""Number of orders that are named in words. Chosen: a sentence holds no more; the map holds all."""
LEAST = 0.01
"""Smallest amplitude of an order that is named, as a share of the strongest. Chosen: a smaller one is not visible
beside it."""


def left_of_torque(told: Data, unseen: Data, nominal: Model) -> tuple[float, float] | None:
    """Residual torque [N.m, root mean square] on the training samples of `unseen`, fitted to those of `told`.

    The first value is by `nominal` as it is, the second with the torque over a turn that it lacks. None where there are
    no overtones: then a search does as well.
    """
    found = repeated(told, nominal)
    if found is None or found.orders.size < 2:
        return None

    def parts(data: Data) -> list[Part]:
        return [_part(run) for run in data.runs if goes_round(nominal, run.measured, run.quantity)]

    return left_unseen(_repeating(nominal), parts(told), parts(unseen))


def with_lesser_orders(data: Data, nominal: Model) -> Model:
    """`nominal` with all orders of the torque over a turn but the strongest, which can then be named as an effect.

    A ripple has overtones. A sine alone leaves so much of them that little else is detected.
    """
    found = repeated(data, nominal)
    return nominal if found is None else _with(nominal, found.lesser)


def with_turn(data: Data, base: Model) -> Model | None:
    """`base` with the torque over a turn that it lacks; None where no torque repeats with the turn."""
    found = repeated(data, base)
    return None if found is None else _with(base, found)


def described_turn(torque: Signal, unit: str) -> str:
    """The strongest orders of a `torque` over a turn, shape (angles, 1), in words."""
    amplitude = 2.0 * np.abs(np.fft.rfft(torque[:-1, 0])) / (torque.shape[0] - 1)
    least = LEAST * float(np.max(amplitude))
    strongest = [order for order in np.argsort(amplitude)[::-1][:MENTIONED] if amplitude[order] > least]
    orders = ", ".join(f"{amplitude[order]:#.2g} {unit} {order} times" for order in strongest)
    return f"it repeats itself with every turn, with {orders}"


def repeated(data: Data, model: Model) -> Balance | None:
    """The torque over a turn that a `model` lacks, from the training samples; None where none repeats with the turn.

    All runs that turn round are used together, since the angle is counted from the same place in all recordings of an
    actuator. The longest run of each recording must show an order by itself: the residuals of pieces of a swing, put
    together, can be mistaken for one.
    """
    own = _repeating(model)
    told = [run for run in data.runs if run.train.any()]
    turning = [run for run in told if goes_round(model, run.measured, run.quantity)]
    for number in {run.number for run in told}:
        longest = max((run for run in told if run.number == number), key=lambda run: run.time.size)
        if all(longest is not run for run in turning) or not over_a_turn(own, [_part(longest)]).orders.size:
            return None
    if not turning:
        return None
    found = over_a_turn(own, [_part(run) for run in turning])
    return found if found.orders.size else None


def _part(run: Run) -> Part:
    return run.inputs, run.time, run.measured, run.train


def _repeating(model: Model) -> Model:
    """`model` with its residual torque only if that repeats with every turn: any other may explain the same torque."""
    residual = model.residual_torque
    return model if residual is not None and "period" in residual else model.with_residual(None)


def _with(model: Model, found: Balance) -> Model:
    """`model` with a torque over a turn added to its own; the last node is the first one again."""
    angle = np.linspace(0.0, TURN, RESIDUAL_ANGLES)
    torque, own = found.torque(angle), _repeating(model).residual_torque
    if own is not None:
        known = np.asarray(own["torque"], dtype=float)
        torque = torque + np.interp(angle, own["angle"], known[:, 0], period=own["period"])
    return model.with_residual(
        {
            "angle": angle,
            "velocity": np.zeros(1),
            "torque": torque[:, np.newaxis],
            "period": TURN,
        }
    )
