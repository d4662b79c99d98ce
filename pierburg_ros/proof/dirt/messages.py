"""What spoils times and messages: losses, clocks, and a duty that is logged badly."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from pierburg_ros.proof.dirt.log import Log, Messages, Random

LATE = 0.02  # s
FAST = 0.002
JITTER = 0.1  # periods


def lost_messages(log: Log, random: Random) -> Log:
    """One message in ten of either topic never arrives, and the numbers tell."""
    return Log(*(each.kept(random.random(each.time.size) >= 0.1) for each in (log.hall, log.duty)))


def lost_rows(log: Log, random: Random) -> Log:
    """One row in ten, Hall voltage and duty, is missing, and no number tells."""
    kept = random.random(log.hall.time.size) >= 0.1
    return Log(log.hall.kept(kept).unnumbered(), log.duty.kept(kept).unnumbered())


def jitter(log: Log, random: Random) -> Log:
    """Messages are stamped off by a tenth of a period."""

    def shaken(messages: Messages) -> Messages:
        period = float(np.median(np.diff(messages.time)))
        off = JITTER * period * random.standard_normal(messages.time.size)
        return replace(messages, time=np.sort(messages.time + off))

    return Log(shaken(log.hall), shaken(log.duty))


def begins_in_motion(log: Log, random: Random) -> Log:
    """The recording begins where the shaft is fastest in the first third."""
    third = log.hall.values[: log.hall.values.size // 3]
    span = max(int(0.05 / np.median(np.diff(log.hall.time))), 1)
    fast = int(np.argmax(np.abs(third[span:] - third[:-span]))) + span // 2
    start = log.hall.time[fast]
    cut = (each.kept(each.time >= start).unnumbered() for each in (log.hall, log.duty))
    return Log(*(replace(each, time=each.time - start) for each in cut))


def coarse_duty(log: Log, random: Random) -> Log:
    """The duty is logged in steps of 1 %."""
    return replace(log, duty=replace(log.duty, values=np.round(log.duty.values, 2)))


def late_duty(log: Log, random: Random) -> Log:
    """The duty is stamped 20 ms after it has acted."""
    return replace(log, duty=replace(log.duty, time=log.duty.time + LATE))


def fast_clock(log: Log, random: Random) -> Log:
    """The clock of the duty is 0.2 % fast."""
    return replace(log, duty=replace(log.duty, time=log.duty.time * (1.0 + FAST)))
