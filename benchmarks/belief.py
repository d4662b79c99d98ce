"""How probable an effect is beside a remainder, from trials: `python benchmarks/belief.py RUN [RUN...]`.

A RUN is the output of `pierburg prove` with the kinds beside, remainder and outside. Every effect that was judged
there, named or doubted, is one case: its evidence, and whether it was concealed. Prints how often those of a
probability are right, and a logistic regression of the same cases, for `diagnosis/search/belief.py`. Writes the first
into its section of docs/developers/measurements.md; --no-write only prints.
"""

import argparse
import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from machine import write_section
from pierburg_ros.diagnosis.search.belief import of_effect
from scipy.optimize import minimize
from scipy.special import expit
from stated import table

BOUNDS = (0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 1.0)
"""Between which probabilities are counted together."""
RIDGE = 0.02
"""Weight of the squared coefficients beside the log likelihood, so that few cases do not make them infinite."""
Case = tuple[tuple[float, float, float], bool]
"""Evidence for an effect: carried, explains, apart; and whether it was concealed."""


def cases(runs: list[Path]) -> Iterator[tuple[Path, Case]]:
    """Every effect that was judged, with the trial it belongs to."""
    for path in sorted(each for run in runs for each in run.glob("trials/*/diagnosis/diagnosis.json")):
        trial, said = path.parent.parent, json.loads(path.read_text())
        concealed = {effect["id"] for effect in json.loads((trial / "truth.json").read_text())["effects"]}
        for effect in (*said["effects"], *said["doubted"]):
            if evidence := effect["evidence"]:
                numbers = (evidence["carried"], evidence["explains"], evidence["apart"])
                yield trial, (numbers, effect["id"] in concealed)


def regression(given: list[Case]) -> np.ndarray:
    """Constant and coefficients of the log odds, shape (4,)."""
    evidence = np.array([[1.0, *numbers] for numbers, _ in given])
    sign = np.where([right for _, right in given], 1.0, -1.0)

    def cost(odds: np.ndarray) -> float:
        return float(np.logaddexp(0.0, -sign * (evidence @ odds)).sum() + RIDGE * np.square(odds[1:]).sum())

    return np.asarray(minimize(cost, np.zeros(4)).x)


def rows(stated: list[float], right: list[bool]) -> str:
    """One row for each range of probability."""
    given = list(zip(stated, right, strict=True))
    return table(given, BOUNDS, ("probability", "effects", "right, by their probabilities"))


def main() -> None:
    """Count, fit, print."""
    parser = argparse.ArgumentParser()
    parser.add_argument("runs", type=Path, nargs="+")
    parser.add_argument("--no-write", action="store_true")
    given = parser.parse_args()
    found = list(cases(given.runs))
    right = [true for _, (_, true) in found]
    count = f"n = {len(found)} effects in {len({trial for trial, _ in found})} trials."
    stated = [of_effect(*numbers) for _, (numbers, _) in found]
    text = f"{rows(stated, right)}\n\n{count} Made by `python benchmarks/belief.py`."
    print(text)
    if not given.no_write:
        write_section("belief", text)
    print("\nconstant, carried, explains, apart:", np.round(regression([case for _, case in found]), 2))
    unseen = []
    for trial, (numbers, _) in found:
        odds = regression([case for other, case in found if other != trial])
        unseen.append(float(expit(odds @ [1.0, *numbers])))
    print("\nwith each trial left out of the regression:\n")
    print(rows(unseen, right))


if __name__ == "__main__":
    main()
