"""One input: made from its seed, read, and judged by how the reading ended."""

from __future__ import annotations

import random
import resource
import signal
import sys
import time
import traceback
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from fuzzing import bag_input, map_input, mcap_input, table_input, yaml_input

from pierburg_ros.actuators import read_actuator
from pierburg_ros.control import read_duty_file, read_parameter_file, read_setpoint_file
from pierburg_ros.errors import InputError
from pierburg_ros.plant.model_file import read_model
from pierburg_ros.recording import read_recording
from pierburg_ros.recording.inspection import inspect

LONGEST_LINE = 300
"""Characters of a message at most."""
SLOW = 10.0
"""Processor time [s] for an input of a fuzzer, which has next to no honest work in it."""
HEAVY = 2 << 30
"""Bytes of memory at most."""
PATIENCE = 120
"""Wall time [s] after which a reading is broken off."""
OUTPUT_OF = Callable[[random.Random], bytes]


@dataclass(frozen=True)
class Kind:
    """How inputs of one reader are made, what the file is called, and what reads it."""

    name: str
    made: Callable[[random.Random], dict[str, bytes]]
    read: Callable[[Path], Any]


def single(name: str, content: OUTPUT_OF) -> Callable[[random.Random], dict[str, bytes]]:
    """Makes inputs of one file."""
    return lambda chance: {name: content(chance)}


def read_schedule(path: Path) -> Any:
    """A setpoint or a duty file, as its header says."""
    duty = b"duty" in path.read_bytes()[:200]
    return read_duty_file(path) if duty else read_setpoint_file(path)


def read_mapped(path: Path) -> Any:
    """What is beside a signal map, by the map; and by the one that is drafted of it, where it can be looked into."""
    recording = next(each for each in (path.with_name("run.csv"), path.with_name("run.mcap")) if each.exists())
    drafted = path.with_name("drafted.yaml")
    try:
        drafted.write_text(inspect(recording).signals, encoding="utf-8")
        read_recording(recording, signals=drafted)
    except InputError as error:
        assert judged(error)[0] == "line", error
    return read_recording(recording, signals=path)


KINDS = (
    Kind("run.mcap", single("run.mcap", mcap_input.mcap), read_recording),
    Kind("bag", bag_input.bag, read_recording),
    Kind("run.db3", single("run.db3", bag_input.database), read_recording),
    Kind("run.csv", single("run.csv", table_input.recorded), read_recording),
    Kind("signals.yaml", map_input.mapped_table, read_mapped),
    Kind("signals.yaml", map_input.mapped_bag, read_mapped),
    Kind("model.yaml", single("model.yaml", yaml_input.model), read_model),
    Kind("actuator.yaml", single("actuator.yaml", yaml_input.actuator), read_actuator),
    Kind("controller.yaml", single("controller.yaml", yaml_input.settings), read_parameter_file),
    Kind("setpoints.csv", single("setpoints.csv", table_input.scheduled), read_schedule),
)


class TooLong(BaseException):
    """The reading took longer than the patience; no handler of a reader may take it for an error of its own."""


@dataclass(frozen=True)
class Outcome:
    """How one reading ended: `how` is result or line where all is well, else what was wrong, with `detail`."""

    seed: int
    kind: str
    how: str
    detail: str
    duration: float

    @property
    def well(self) -> bool:
        """Whether it ended in a result or one line."""
        return self.how in ("result", "line")


def case(seed: int) -> tuple[Kind, dict[str, bytes]]:
    """The reader and the files of one seed."""
    chance = random.Random(seed)
    kind = KINDS[seed % len(KINDS)]
    return kind, kind.made(chance)


def write(files: dict[str, bytes], folder: Path) -> None:
    """Write the files of an input."""
    for name, content in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)


def tried(seed: int, folder: Path) -> Outcome:
    """How the input of `seed`, written into the empty `folder`, ends."""
    kind, files = case(seed)
    write(files, folder)
    before, began = peak(), time.process_time()
    how, detail = ending(kind, folder)
    duration = time.process_time() - began
    if how in ("result", "line") and peak() > max(before, HEAVY):
        how, detail = "memory", f"{peak() / 2**30:.1f} GiB"
    elif how in ("result", "line") and duration > SLOW:
        how, detail = "slow", detail
    return Outcome(seed, kind.name, how, detail, duration)


def ending(kind: Kind, folder: Path) -> tuple[str, str]:
    """How reading the input in `folder` ends, and what was said."""
    signal.signal(signal.SIGALRM, broken_off)
    signal.alarm(PATIENCE)
    try:
        return "result", fault_of(kind.read(folder / kind.name))
    except InputError as error:
        return judged(error)
    except TooLong:
        return "slow", f"broken off after {PATIENCE} s"
    except MemoryError:
        return "memory", "MemoryError"
    except BaseException as error:
        return "traceback", where(error)
    finally:
        signal.alarm(0)


def broken_off(*_: object) -> None:
    """Ends a reading that takes too long."""
    raise TooLong


def judged(error: InputError) -> tuple[str, str]:
    """Whether a refusal is one printable line of the allowed length."""
    line = str(error)
    if isinstance(error.__cause__, MemoryError):
        return "memory", "MemoryError"
    if len(line) > LONGEST_LINE or "\n" in line or not line.isprintable():
        return "message", f"{len(line)} characters: {line[:80]!r}"
    return "line", line


def fault_of(found: Any) -> str:
    """Raises where a result holds what no later step can bear."""
    arrays = [found.time, found.measured] if hasattr(found, "measured") else []
    if not all(np.all(np.abs(each) < 1e12) for each in arrays):
        raise AssertionError("a result that is not finite or beyond any bench")
    return ""


def where(error: BaseException) -> str:
    """Type of an exception and the last place of the package that it went through."""
    frames = [frame for frame in traceback.extract_tb(error.__traceback__) if "pierburg_ros/" in frame.filename]
    last = frames[-1] if frames else None
    return f"{type(error).__name__} at {Path(last.filename).name}:{last.name}" if last else type(error).__name__


def peak() -> int:
    """The most memory [bytes] that this process has had."""
    factor = 1 if sys.platform == "darwin" else 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * factor
