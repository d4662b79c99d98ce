"""Messages that never came, counted from the numbers that their publishers give them. Knows no ROS."""

from __future__ import annotations


class Numbering:
    """Follows the numbers of one topic, on which one or several publishers count from 1, each on its own."""

    def __init__(self) -> None:
        self.received = 0
        self.lost = 0
        self._last: list[int] = []

    def take(self, number: int, publishers: int) -> int:
        """How many messages are missing before the one with this `number`, on a topic of so many `publishers`.

        A number that follows none of the last ones is a publisher's first, as long as not all are known. With all
        of them known it belongs to the one that comes closest below it. A number below all is a publisher that
        was started again.
        """
        self.received += 1
        if number - 1 in self._last:
            self._last[self._last.index(number - 1)] = number
            return 0
        below = [last for last in self._last if last < number]
        if len(self._last) < max(publishers, 1) or not below:
            self._begin(number, max(publishers, 1))
            return 0
        closest = max(below)
        self._last[self._last.index(closest)] = number
        self.lost += number - closest - 1
        return number - closest - 1

    def forget_counts(self) -> None:
        """Count anew, as in a new file, while the numbering goes on."""
        self.received = self.lost = 0

    def _begin(self, number: int, publishers: int) -> None:
        """Follow one more publisher, in place of the longest known one where there are too many."""
        self._last = [*self._last, number][-publishers:]
