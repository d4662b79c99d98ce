"""Messages that never came, counted from the numbers that each publisher gives its own. Knows no ROS."""

from __future__ import annotations


class Numbering:
    """Follows the numbers of every publisher; how many there are, and which come and go, does not matter."""

    def __init__(self) -> None:
        self._last: dict[bytes, int] = {}

    def take(self, publisher: bytes, number: int) -> int:
        """How many messages of this `publisher` are missing before its one with this `number`.

        What it sent before its first message here cannot be counted; a number that comes again is the past of a topic.
        """
        last = self._last.get(publisher, number - 1)
        self._last[publisher] = max(last, number)
        return max(number - last - 1, 0)
