"""Simulates random parameter sets far beyond what is plausible, and counts those that are slow or give no number.

    python benchmarks/parameter_sets.py --count 1000000 --output parameter_sets.jsonl

A set draws base parameters anywhere in their ranges and up to six effects up to `FAR` times what is plausible, ends
included; pairs that contradict each other are put in order. It starts anywhere on the travel, and runs the time of one
travel through steps, reversals and an open bridge. A process that stays with one set longer than `HANGS` is ended.
Called again with the same output it goes on; `--seed` shows one set again.
"""

from __future__ import annotations

import argparse
import json
import math
import multiprocessing
import os
import time
from collections import Counter
from functools import cache
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

BATCH = 1000
SLOW = 2.5
"""Processor time [s] for the time of one travel: the burst that is allowed, and as much again."""
HANGS = 60.0
MOST_EFFECTS = 6
FAR = 1000.0
"""Reach of an effect's parameters, in multiples of what is plausible."""
CHANGES = 8
"""Changes of the duty in a run."""
DUTIES = (-1.0, -0.3, 0.0, 0.1, 0.24, 0.5, 1.0)
SAMPLES = 51


def main() -> None:
    """Run the batches that the output does not hold yet."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=1_000_000)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--output", type=Path, default=Path("parameter_sets.jsonl"))
    parser.add_argument("--seed", type=int, help="show and run this set")
    given = parser.parse_args()
    if given.seed is not None:
        print(json.dumps(tried(given.seed), indent=1))
        return
    lines = [json.loads(line) for line in given.output.read_text().splitlines()] if given.output.exists() else []
    done = {line["batch"] for line in lines if "batch" in line}
    batches = [first for first in range(given.first, given.first + given.count, BATCH) if first not in done]
    with given.output.open("a") as output:
        for line in worked(batches, given.workers):
            lines.append(line)
            output.write(json.dumps(line) + "\n")
            output.flush()
    report(lines)


def worked(batches: list[int], workers: int) -> Any:
    """The lines of all batches, from processes that are replaced where one stays with a set."""
    left, running = batches[::-1], [Worker() for _ in range(workers)]
    while left or any(worker.busy for worker in running):
        for worker in running:
            if not worker.busy and left:
                worker.start(left.pop(), set())
            yield from worker.news()
        time.sleep(0.05)


class Worker:
    """A process that runs one batch after another, and tells which set it is at."""

    def __init__(self) -> None:
        self.process: Any = None
        self.busy = False

    def start(self, batch: int, skipped: set[int]) -> None:
        """Have a batch run, without the sets `skipped`."""
        if self.process is None:
            context = multiprocessing.get_context("spawn")
            self.at = context.Value("q", -1)
            self.pipe, other = context.Pipe()
            self.process = context.Process(target=serve, args=(other, self.at), daemon=True)
            self.process.start()
        self.batch, self.skipped, self.busy = batch, skipped, True
        self.seen, self.since = -1, time.monotonic()
        self.pipe.send((batch, sorted(skipped)))

    def news(self) -> Any:
        """What has come; a set that hangs is a line of its own, and its batch starts again without it."""
        if not self.busy:
            return
        if self.at.value != self.seen:
            self.seen, self.since = self.at.value, time.monotonic()
        while self.pipe.poll():
            line = self.pipe.recv()
            self.busy = "batch" not in line
            yield line
        if self.busy and self.seen >= 0 and time.monotonic() - self.since > HANGS:
            self.process.kill()
            self.process.join()
            self.process = None
            yield {"seed": self.seen, "how": "hang", "duration": HANGS, "values": drawn(self.seen)[1]}
            self.start(self.batch, self.skipped | {self.seen})


def serve(pipe: Connection, at: Any) -> None:
    """Run batches until the pipe closes."""
    tried(0)
    while True:
        batch, skipped = pipe.recv()
        counts: Counter[str] = Counter()
        for seed in range(batch, batch + BATCH):
            if seed not in skipped:
                at.value = seed
                found = tried(seed)
                counts[found["how"]] += 1
                if found["how"] != "numbers":
                    pipe.send(found)
        pipe.send({"batch": batch, "counts": counts})


def tried(seed: int) -> dict[str, Any]:
    """How the run of one set ends: numbers, slow, or not a number from some sample on."""
    import numpy as np

    from pierburg_ros.plant import simulate

    model, values = drawn(seed)
    inputs, times, angle, velocity = driven(seed, model)
    began = time.process_time()
    output = simulate(model, inputs, times, angle, velocity)
    duration = time.process_time() - began
    missing = int(np.count_nonzero(~np.isfinite(output)))
    how = "not a number" if missing else "slow" if duration > SLOW else "numbers"
    return {"seed": seed, "how": how, "missing": missing, "duration": duration, "values": values}


def driven(seed: int, model: Any) -> tuple[Any, Any, float, float]:
    """Inputs, sample times [s], angle [rad] and velocity [rad/s] at the start: anywhere, in the time of one travel."""
    import numpy as np

    from pierburg_ros.plant import Inputs

    random = np.random.default_rng([seed, 1])
    own, actuator = model.scales, model.actuator
    changes = np.sort(random.uniform(-0.1, 1.0, CHANGES)) * own.time
    duty = random.choice(DUTIES, CHANGES)
    inputs = Inputs(changes, duty, enabled=random.random(CHANGES) > 0.1)
    lower, upper = max(actuator.lower_stop, -own.angle), min(actuator.upper_stop, own.angle)
    velocity = random.uniform(-1.0, 1.0) * own.angle / own.time if random.random() < 0.3 else 0.0
    return inputs, np.linspace(0.0, own.time, SAMPLES), float(random.uniform(lower, upper)), velocity


def drawn(seed: int) -> tuple[Any, dict[str, float]]:
    """A model anywhere in its ranges, and the values that differ from nominal."""
    import numpy as np

    from pierburg_ros.effects import EFFECTS
    from pierburg_ros.errors import InputError
    from pierburg_ros.inference.coordinates import in_order

    random = np.random.default_rng(seed)
    nominal = described(("pierburg", "xl330")[seed % 2])
    while True:
        names = [name for name in nominal.actuator.parameters if random.random() < 0.5]
        for index in random.permutation(len(EFFECTS))[: random.integers(0, MOST_EFFECTS + 1)]:
            names += [f"{EFFECTS[index].id}.{name}" for name in EFFECTS[index].names]
        values = {name: anywhere(random, *reach(nominal, name), choices(name)) for name in names}
        try:
            values = in_order(values, nominal)
            return nominal.with_values(values), values
        except InputError:
            continue


@cache
def described(name: str) -> Any:
    """An actuator of the package as described."""
    from pierburg_ros.actuators import read_actuator
    from pierburg_ros.plant import Model

    return Model.nominal(read_actuator(name))


def reach(nominal: Any, name: str) -> tuple[float, float]:
    """Where a parameter is drawn: in its range, and for an effect up to `FAR` times what is plausible."""
    from pierburg_ros.effects import DECLARED

    minimum, maximum = nominal.range(name)
    if name not in DECLARED:
        return minimum, maximum
    far = FAR * max(map(abs, DECLARED[name].expected(nominal.scales)))
    return max(minimum, -far), min(maximum, far)


def choices(name: str) -> tuple[float, ...]:
    """The only values that a parameter takes, where there are such."""
    from pierburg_ros.effects import EFFECT

    effect, _, own = name.partition(".")
    return EFFECT[effect].parameter(own).choices if own else ()


def anywhere(random: Any, minimum: float, maximum: float, choices: tuple[float, ...]) -> float:
    """A value in a range: even, even in its logarithm, or an end."""
    if choices:
        return float(random.choice(choices))
    how = random.random()
    if how < 0.1:
        return float(random.choice([minimum, maximum]))
    if how < 0.5:
        return float(random.uniform(minimum, maximum))
    low = max(minimum, maximum * 1e-7)
    return float(math.exp(random.uniform(math.log(low), math.log(maximum)))) if low > 0.0 else minimum


def report(lines: list[dict[str, Any]]) -> None:
    """Print the counts, and what the sets that gave no numbers have in common."""
    total = sum((Counter(line["counts"]) for line in lines if "batch" in line), Counter[str]())
    found = [line for line in lines if "seed" in line]
    hangs = [line for line in found if line["how"] == "hang"]
    print(f"{sum(total.values()) + len(hangs)} sets: {dict(total)}, hang {len(hangs)}")
    for how in ("hang", "slow", "not a number"):
        those = [line for line in found if line["how"] == how]
        acting = ({name.split(".")[0] for name in line["values"] if "." in name} for line in those)
        effects = Counter(effect for each in acting for effect in each)
        print(f"{how}: {len(those)}, seeds {[line['seed'] for line in those[:5]]}, with {effects.most_common(8)}")


if __name__ == "__main__":
    main()
