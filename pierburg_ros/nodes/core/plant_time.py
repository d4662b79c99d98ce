"""When the plant ticks: by the clock, or as the source of simulated time, alone or in lockstep."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from threading import Event, Semaphore

from pierburg_ros.errors import InputError
from pierburg_ros.nodes.core.pacing import Pacer
from pierburg_ros.nodes.core.ticking import Ticking

SECOND = 1_000_000_000
"""Nanoseconds in a second."""
REPEAT = 0.2
"""A sample without reply is sent again after this time [s]."""
GIVE_UP = 5.0
"""Without any reply the run ends after this time [s]."""
PARTNER_LOOK = 0.02
"""Time [s] between two looks for the partners of a run in lockstep."""


def tick_by_clock(plant: Ticking) -> None:
    """Tick at the rate; a tick has the time of the node's clock, so a late one advances further."""
    while not plant.stopping.is_set():
        plant.pacer.period = 1.0 / plant.values["rate"]
        plant.pacer.wait()
        now = plant.now()
        if plant.follows(now):
            plant.publish(plant.tick(now))


def tick_as_time_source(plant: Ticking, lockstep: Lockstep | None) -> None:
    """Tick k has the time of k periods, counted from 1, for ROS takes time 0 for none."""
    pacer = Pacer(0.0)
    now = 0
    while not plant.stopping.is_set():
        period = 1.0 / plant.values["rate"]
        now += round(period * SECOND)
        sample = plant.tick(now)
        if lockstep is None:
            plant.publish(sample, with_clock=True)
        else:
            lockstep.exchange(partial(plant.publish, sample, with_clock=True))
        factor = plant.values["time_factor"]
        pacer.period = period / factor if factor > 0.0 else 0.0
        pacer.wait()
        if plant.held_back is not None and plant.held_back.wait(now, round(period * SECOND)):
            pacer.restart()


class Lockstep:
    """One duty for one sample, whatever the machine is doing meanwhile."""

    def __init__(self, stopping: Event) -> None:
        self._stopping = stopping
        self._replies = Semaphore(0)

    def reply(self) -> None:
        """A duty has come."""
        self._replies.release()

    def wait_for_partners(self, present: Callable[[], bool]) -> None:
        """Return once the samples are read and duties are sent."""
        while not present() and not self._stopping.wait(PARTNER_LOOK):
            pass

    def exchange(self, send: Callable[[], None]) -> None:
        """Send a sample, again if need be, and return when its duty is there; InputError when none comes."""
        while self._replies.acquire(blocking=False):
            pass
        for repeats in range(round(GIVE_UP / REPEAT)):
            if self._stopping.is_set():
                return
            send()
            if self._replies.acquire(timeout=REPEAT):
                self._await_surplus(repeats)
                return
        raise InputError(
            f"No duty came within {GIVE_UP:g} s of a Hall sample in lockstep; expected a controller on this "
            "graph. Start it, or start the plant without lockstep."
        )

    def _await_surplus(self, repeats: int) -> None:
        """Let the replies to repeated samples arrive; none may pass for that to the next sample."""
        for _ in range(repeats):
            if not self._replies.acquire(timeout=REPEAT):
                return
