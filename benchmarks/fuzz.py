"""Reads inputs that are nearly right, each made from its seed, and counts how the reading ends.

    python benchmarks/fuzz.py --count 200000 --output fuzz.jsonl

Every input must end in a result or in one line of at most 300 characters, within 10 s and 2 GiB. What does not
is written to the output, a line each; `--seed` makes one input again. Called again with the same output it goes on.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import os
import resource
import shutil
import sys
import tempfile
import time
from collections import Counter
from multiprocessing.connection import Connection, wait
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parent.parent
BATCH = 200
"""Inputs that a process reads before it reports."""
ADDRESS_SPACE = 6 << 30
"""Bytes [address space] after which a process is refused more, so that a bomb does not take the machine."""
HANGS = 150.0
"""Time [s] after which a process that says nothing is ended."""


def main() -> None:
    """Run the seeds that the output does not hold yet."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=200_000)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--output", type=Path, default=Path("fuzz.jsonl"))
    parser.add_argument("--seed", type=int, help="write the input of this seed to a folder of its name, and read it")
    given = parser.parse_args()
    sys.path.insert(0, str(ROOT / "test"))
    if given.seed is not None:
        return one(given.seed)
    done = Run(given.output)
    batches = [first for first in range(given.first, given.first + given.count, BATCH) if first not in done.batches]
    done.work(batches, given.workers)
    done.report()


def one(seed: int) -> None:
    """Make and read one input again."""
    from fuzzing.trial import case, tried, write

    kind, files = case(seed)
    write(files, Path(f"fuzz-{seed}"))
    with tempfile.TemporaryDirectory() as folder:
        print(kind.name, tried(seed, Path(folder)))


class Run:
    """What has been tried, kept in a file of one line a batch or a finding."""

    def __init__(self, path: Path) -> None:
        self.path = path
        lines = [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []
        self.batches = {line["batch"]: line["counts"] for line in lines if "batch" in line}
        self.findings = [line for line in lines if "seed" in line]

    def work(self, batches: list[int], workers: int) -> None:
        """Hand out the batches, and replace a process that a reading has ended or stopped."""
        left = batches[::-1]
        pool = [Worker() for _ in range(workers)]
        for worker in pool:
            worker.start(left.pop() if left else None)
        while any(worker.batch is not None for worker in pool):
            wait([worker.pipe for worker in pool if worker.batch is not None], timeout=5.0)
            for worker in pool:
                for line in worker.news():
                    self.note(line)
                if worker.batch is None and left:
                    worker.start(left.pop())

    def note(self, line: dict[str, Any]) -> None:
        """Keep a line."""
        with self.path.open("a") as file:
            file.write(json.dumps(line) + "\n")
        if "seed" in line:
            self.findings.append(line)
        else:
            self.batches[line["batch"]] = line["counts"]
            print(f"{BATCH * len(self.batches)} read, {len(self.findings)} findings", end="\r", file=sys.stderr)

    def report(self) -> None:
        """Print how many inputs ended how, and the findings by kind and place."""
        total = sum((Counter(counts) for counts in self.batches.values()), Counter[str]())
        print(f"{sum(total.values())} inputs: {dict(total.most_common())}")
        kinds = Counter(sort(finding) for finding in self.findings)
        for (kind, how, detail), count in kinds.most_common(60):
            seed = next(found["seed"] for found in self.findings if sort(found) == (kind, how, detail))
            print(f"{count:6d}  {kind:16} {how:10} {detail}  (seed {seed})")


def sort(finding: dict[str, Any]) -> tuple[str, str, str]:
    """What makes two findings the same: the reader, how it ended, and where; a message's own words do not."""
    return finding["kind"], finding["how"], "" if finding["how"] == "message" else finding["detail"]


class Worker:
    """A process that reads a batch of inputs at a time."""

    def __init__(self) -> None:
        self.batch: int | None = None
        self.at: int | None = None
        self.skipped: set[int] = set()
        self.process: Any = None

    def start(self, batch: int | None) -> None:
        """Have the process read a batch; None: nothing is left."""
        if batch is None:
            return
        if self.process is None:
            context = multiprocessing.get_context("spawn")
            self.pipe, other = context.Pipe()
            self.process = context.Process(target=serve, args=(other,), daemon=True)
            self.process.start()
            other.close()
        self.batch, self.heard = batch, time.monotonic()
        self.pipe.send((batch, sorted(self.skipped)))

    def news(self) -> list[dict[str, Any]]:
        """The lines that have come; a process that died or hangs has its input noted and is replaced."""
        lines: list[dict[str, Any]] = []
        try:
            while self.batch is not None and self.pipe.poll():
                line = self.pipe.recv()
                self.heard = time.monotonic()
                self.at = line.pop("at", None)
                if line:
                    lines.append(line)
                if "batch" in line:
                    self.batch = None
        except (EOFError, ConnectionResetError):
            lines += self.lost("killed")
        if self.batch is not None and time.monotonic() - self.heard > HANGS:
            lines += self.lost("hang")
        return lines

    def lost(self, how: str) -> list[dict[str, Any]]:
        """Start anew after an input that ended or stopped the process."""
        self.process.kill()
        self.process.join()
        if self.at is None:
            raise SystemExit("The process that reads inputs ended before its first one.")
        at, batch, self.process, self.batch = self.at, self.batch, None, None
        self.skipped.add(at)
        self.start(batch)
        return [{"seed": at, "kind": "?", "how": how, "detail": "", "duration": HANGS}]


def serve(pipe: Connection) -> None:
    """Read batches until the pipe closes."""
    sys.path.insert(0, str(ROOT / "test"))
    from fuzzing.trial import tried

    resource.setrlimit(resource.RLIMIT_AS, (ADDRESS_SPACE, ADDRESS_SPACE))
    base = "/dev/shm" if Path("/dev/shm").is_dir() else None
    while True:
        try:
            batch, skipped = pipe.recv()
        except EOFError:
            return
        counts: Counter[str] = Counter()
        for seed in range(batch, batch + BATCH):
            if seed in skipped:
                counts["hang or killed"] += 1
                continue
            pipe.send({"at": seed})
            folder = tempfile.mkdtemp(dir=base)
            try:
                outcome = tried(seed, Path(folder))
            finally:
                shutil.rmtree(folder, ignore_errors=True)
            counts[outcome.how] += 1
            if not outcome.well:
                pipe.send(vars(outcome))
        pipe.send({"batch": batch, "counts": counts})


if __name__ == "__main__":
    main()
