"""Blind trials through the inference alone: which names, which drifts, how many simulations.

usage: python benchmarks/inference.py SEED KIND=COUNT...        (kinds as in `pierburg prove`)
"""

from __future__ import annotations

import sys
import time

from pierburg_ros.actuators import read_actuator
from pierburg_ros.inference.fit import rms_of
from pierburg_ros.inference.infer import infer
from pierburg_ros.plant import Model
from pierburg_ros.proof.bench import record
from pierburg_ros.proof.concealment import draw, schedule
from pierburg_ros.recording import Channel, Recording


def main() -> None:
    """Print one line a trial, and how many are right."""
    seed, counts = int(sys.argv[1]), {kind: int(n) for kind, n in (each.split("=") for each in sys.argv[2:])}
    nominal, right, total = Model.nominal(read_actuator("pierburg")), 0, 0
    print("trial | hidden | verdict: names, drifts | error over noise | held out over best | simulations | CPU [s]")
    for kind, number in schedule(counts):
        trial = draw(kind, number, seed)
        run = record(trial)
        recording = Recording(trial.name, "hall_voltage", run.time, run.measured, Channel(run.time, run.duty))
        began = time.process_time()
        choice = infer([recording], nominal).choice
        best, held_out = choice.chosen, choice.predictor.fitter.data.validation
        names = set(best.explanation.effects) | ({"sensor_quantization"} if best.fitter.data.step else set())
        told = (choice.verdict, names) == (trial.verdict, set(trial.effect_ids) if trial.kind != "outside" else set())
        right, total = right + told, total + 1
        least = min(rms_of(fit, held_out) for fit in choice.fits)
        found = "+".join((*sorted(names), *best.explanation.drifted)) or "nothing"
        print(
            f"{trial.name} | {'+'.join((*trial.effect_ids, *trial.drifted)) or 'nothing'} | {choice.verdict}: {found} |"
            f" {best.ratio:.3f} | {rms_of(choice.predictor, held_out) / least:.3f} |"
            f" {best.fitter.effort.simulations} | {time.process_time() - began:.0f}{'' if told else '  WRONG'}",
            flush=True,
        )
    print(f"right: {right} of {total}")


if __name__ == "__main__":
    main()
