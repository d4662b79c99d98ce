"""What a file format of recordings declares: how its files are told from others, and what reads them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from pierburg_ros.errors import printable
from pierburg_ros.recording.columns import Columns
from pierburg_ros.recording.formats.messages import Bag, Wanted


@dataclass(frozen=True)
class Format:
    """One file format.

    `looks_like` is asked with the path and the first bytes of the file, none for a folder; `read` gives messages or
    columns, of those topics or columns that are wanted by their name.
    """

    name: str
    looks_like: Callable[[Path, bytes], bool]
    read: Callable[[Path, Wanted], Bag | Columns]


def as_bag(read: Callable[[Path, Bag], None]) -> Callable[[Path, Wanted], Bag]:
    """A reader that fills a bag, as one that gives it."""

    def given(path: Path, wanted: Wanted) -> Bag:
        bag = Bag(printable(path.name), wanted)
        read(path, bag)
        return bag

    return given
