"""Which senders keep sending, so that one whose messages are still on the way is noticed. Knows no ROS."""

from __future__ import annotations

from collections import deque
from collections.abc import Set

STEADY = 20
"""Messages that a steady sender has sent within `WITHIN`: signals come at 20 Hz and more, states and reports seldom."""
WITHIN = 1_000_000_000
"""A second [ns]."""


class SteadySenders:
    """Remembers when the latest messages of every sender were sent [ns]."""

    def __init__(self) -> None:
        self._sent: dict[bytes, deque[int]] = {}

    def take(self, sender: bytes, sent: int) -> None:
        """A message of `sender` has come."""
        self._sent.setdefault(sender, deque(maxlen=STEADY)).append(sent)

    def behind(self, present: Set[bytes], time: int) -> set[bytes]:
        """The steady ones among those `present` of whom nothing has come that was sent after `time` [ns]."""
        return {
            sender
            for sender in present & self._sent.keys()
            if (sent := self._sent[sender])[-1] <= time and len(sent) == STEADY and sent[-1] - sent[0] <= WITHIN
        }
