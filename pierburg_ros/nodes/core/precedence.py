"""Which of several controllers may send duties: the one that was there first."""

from __future__ import annotations

from collections.abc import Set

SETTLE = 1.0
"""Time [s] after the start before anything is sent: DDS discovery on one machine takes 0.1 to 0.5 s."""
SILENT = 1.0
"""A rival that sends no duty for this long [s], while samples ask for them, is gone or dead. A killed process stays
on the graph for 20 s, which is the lease of its participant."""
TIE = 10.0
"""Two that began within this time [s] of each other are a tie, which the smaller endpoint id wins. Generous, for
discovery on a machine that does much else."""


class Precedence:
    """Decides from the publishers on the graph, told again and again."""

    def __init__(self, started: float) -> None:
        """`started` [s], like every time here by a steady clock."""
        self._passive_since = started
        self._started = started
        self._active_since: float | None = None
        self._heard = started
        self._dead: set[str] = set()
        self.rivals: Set[str] = frozenset()

    def heard(self, now: float) -> None:
        """A rival's duty came."""
        self._heard = now

    def stand_down(self, now: float) -> None:
        """Give up the place by choice; the next `may_send` asks anew."""
        self._active_since, self._passive_since = None, now

    def may_send(self, now: float, others: Set[str], own: str, asked: bool) -> bool:
        """Whether to send, beside publishers `others`, oneself being `own`; `asked`: samples wait for duties."""
        self._dead &= others
        self.rivals = others - self._dead
        if self._active_since is not None:
            self._yield(now, own)
        elif now - self._started >= SETTLE and (not self.rivals or (asked and self._is_silent(now))):
            self._dead |= self.rivals
            self.rivals = frozenset()
            self._active_since = now
        return self._active_since is not None

    def _yield(self, now: float, own: str) -> None:
        is_tie = self._active_since is not None and now - self._active_since < TIE
        if self.rivals and is_tie and own > min(self.rivals):
            self.stand_down(now)

    def _is_silent(self, now: float) -> bool:
        return now - max(self._heard, self._passive_since) > SILENT
